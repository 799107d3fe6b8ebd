// The browser's half of rastrum.View: tells the kernel how the mouse moves, shows the pictures that come back. One request is
// under way at a time, and what the mouse does meanwhile is summed up, so that a slow kernel is never behind.
const REST_MS = 150; // the whole picture after that

export function render({ model, el }) {
  const canvas = document.createElement("canvas");
  canvas.width = model.get("width");
  canvas.height = model.get("height");
  canvas.style.cssText = "max-width: 100%; touch-action: none; cursor: grab";
  const words = document.createElement("pre");
  words.style.cssText = "margin: 0; color: #b00020; white-space: pre-wrap";
  el.append(canvas, words);
  const context = canvas.getContext("2d");

  let pending = null; // what the mouse did since the last request
  let waiting = false;
  let resting = null;

  function request() {
    if (waiting || pending === null) return;
    waiting = true;
    model.send(pending);
    pending = null;
  }
  function change(what) {
    pending ??= {};
    for (const key of ["turn", "pan"])
      if (what[key]) {
        const [x, y] = pending[key] ?? [0, 0];
        pending[key] = [x + what[key][0], y + what[key][1]];
      }
    if (what.zoom) pending.zoom = (pending.zoom ?? 1) * what.zoom;
    if (what.home) pending = { home: true };
    request();
    clearTimeout(resting);
    resting = setTimeout(rest, REST_MS);
  }
  function rest() {
    if (waiting) {
      resting = setTimeout(rest, REST_MS);
      return;
    }
    pending ??= {};
    request();
  }

  async function shown(answer, buffers) {
    words.textContent = answer.error ?? "";
    if (buffers && buffers.length > 0) {
      const image = await createImageBitmap(new Blob([buffers[0]], { type: "image/png" }));
      context.clearRect(0, 0, canvas.width, canvas.height);
      context.drawImage(image, 0, 0, canvas.width, canvas.height);
      image.close();
    }
    waiting = false;
    request();
  }
  model.on("msg:custom", shown);

  let dragged = null; // {x, y, pan} of the last event
  const side = () => Math.min(canvas.clientWidth, canvas.clientHeight) || 1;
  canvas.addEventListener("pointerdown", (event) => {
    dragged = { x: event.clientX, y: event.clientY, pan: event.button === 1 || event.shiftKey };
    canvas.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (dragged === null) return;
    const by = [(event.clientX - dragged.x) / side(), (event.clientY - dragged.y) / side()];
    dragged.x = event.clientX;
    dragged.y = event.clientY;
    change(dragged.pan ? { pan: by } : { turn: by });
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, () => {
      dragged = null;
    });
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      change({ zoom: 1.15 ** (-Math.sign(event.deltaY)) });
    },
    { passive: false },
  );
  canvas.addEventListener("dblclick", () => change({ home: true }));

  pending = {};
  request();
  return () => {
    clearTimeout(resting);
    model.off("msg:custom", shown);
  };
}

export default { render };
