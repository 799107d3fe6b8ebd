// The browser's half of rastrum.View without a browser: what it asks for when the mouse moves. usage: node view_test.mjs _view.js
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const source = readFileSync(process.argv[2], "utf-8");
const { render } = await import("data:text/javascript," + encodeURIComponent(source));

const drawn = [];
class Element {
  style = {};
  clientWidth = 400;
  clientHeight = 200;
  listeners = {};
  append(...all) {
    this.children = all;
  }
  addEventListener(name, listener) {
    this.listeners[name] = listener;
  }
  setPointerCapture() {}
  getContext() {
    return { clearRect() {}, drawImage: (...all) => drawn.push(all) };
  }
}
globalThis.document = { createElement: () => new Element() };
globalThis.createImageBitmap = async (blob) => ({ size: blob.size, close() {} });
let timers = new Map();
let last = 0;
globalThis.setTimeout = (f) => (timers.set(++last, f), last);
globalThis.clearTimeout = (id) => timers.delete(id);
function pass() {
  const due = [...timers.values()];
  timers = new Map();
  for (const f of due) f();
}

const sent = [];
let answer = null;
const model = {
  get: (name) => ({ width: 800, height: 400 })[name],
  send: (message) => sent.push(message),
  on: (name, f) => (answer = f),
  off: () => (answer = null),
};
const el = new Element();
const end = render({ model, el });
const [canvas, words] = el.children;
const event = (more) => ({ preventDefault() {}, pointerId: 1, button: 0, shiftKey: false, ...more });
const mouse = (name, more) => canvas.listeners[name](event(more));
const frame = () => answer({ whole: true }, [new DataView(new ArrayBuffer(7))]);

assert.deepEqual(sent, [{}], "the first picture is asked for at once");
await frame();
assert.equal(drawn[0][0].size, 7);
assert.deepEqual(drawn[0].slice(1), [0, 0, 800, 400], "it fills the canvas, whatever its size");

// One request is under way; what happens meanwhile is summed up, by parts of the smaller side.
mouse("pointerdown", { clientX: 100, clientY: 100 });
mouse("pointermove", { clientX: 120, clientY: 100 });
mouse("pointermove", { clientX: 140, clientY: 110 });
mouse("pointermove", { clientX: 140, clientY: 90 });
assert.deepEqual(sent.slice(1), [{ turn: [0.1, 0] }]);
await frame();
assert.equal(sent.length, 3);
assert.ok(Math.abs(sent[2].turn[0] - 0.1) < 1e-12 && Math.abs(sent[2].turn[1] + 0.05) < 1e-12);

// At rest the whole picture is asked for, once the one under way is there.
pass();
assert.equal(sent.length, 3);
await frame();
pass();
assert.deepEqual(sent[3], {});
pass();
assert.equal(sent.length, 4, "and only once");
await frame();

mouse("pointerup", {});
mouse("pointermove", { clientX: 0, clientY: 0 });
assert.equal(sent.length, 4, "nothing turns without a button");
mouse("pointerdown", { clientX: 0, clientY: 0, shiftKey: true });
mouse("pointermove", { clientX: 0, clientY: 20 });
assert.deepEqual(sent[4], { pan: [0, 0.1] });
mouse("wheel", { deltaY: -3 });
mouse("wheel", { deltaY: -3 });
await frame();
assert.ok(Math.abs(sent[5].zoom - 1.15 ** 2) < 1e-12);
mouse("dblclick", {});
await answer({ error: "positions: gone" }, []);
assert.equal(words.textContent, "positions: gone");
assert.deepEqual(sent[6], { home: true });
await frame();
assert.equal(words.textContent, "");
end();
assert.ok(answer === null && timers.size === 0);
