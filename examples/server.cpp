// SPDX-License-Identifier: BSD-3-Clause
// A server of pictures: four threads take requests from a queue. They share the scene, which does
// not change; each has its own renderer. The server's end stops the current frames.
#include <cmath>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <rastrum/io.hpp>
#include <rastrum/render.hpp>
#include <rastrum/shapes.hpp>

using Picture = rastrum::Image<rastrum::Rgba8>;
/// The future has the picture or an Error; Stopped if the server has ended.
using Request = std::packaged_task<Picture(rastrum::Renderer&, std::stop_token)>;

int main() {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::deque<Request> queue;
  const auto serve = [&](std::stop_token stop) {
    rastrum::Renderer renderer({.threads = 1});
    for (;;) {
      std::unique_lock lock(mutex);
      if (!changed.wait(lock, stop, [&] { return !queue.empty(); })) return;
      Request request = std::move(queue.front());
      queue.pop_front();
      lock.unlock();
      request(renderer, stop);
    }
  };

  const rastrum::Scene knot = rastrum::shapes::scene_from_spec("torus_knot");
  const rastrum::SceneBinding scene(knot);
  const rastrum::FrameOptions frame{.width = 320, .height = 240, .lights = rastrum::light_kit()};
  std::vector<std::jthread> threads;  // end before what they read
  for (int i = 0; i < 4; ++i) threads.emplace_back(serve);
  std::vector<std::future<Picture>> pictures;
  for (int i = 0; i < 12; ++i) {
    const rastrum::Camera camera{.eye = {3 * std::sin(0.5 * i), 1, 3 * std::cos(0.5 * i)}};
    Request request([&, camera](rastrum::Renderer& renderer, std::stop_token stop) {
      Picture picture(frame.width, frame.height);
      renderer.render(scene.view(), camera, frame, {.color8 = picture}, {}, stop);
      return picture;
    });
    pictures.push_back(request.get_future());
    const std::scoped_lock lock(mutex);
    queue.push_back(std::move(request));
    changed.notify_one();
  }
  for (std::size_t i = 0; i < pictures.size(); ++i)
    rastrum::io::write_png("server" + std::to_string(i) + ".png", pictures[i].get());
}
