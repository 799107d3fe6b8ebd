// SPDX-License-Identifier: BSD-3-Clause
// Draws Dear ImGui's lists with SDL_Renderer, so that no OpenGL is needed. Debian's package has
// ImGui's own file for that only as an example.
#pragma once

struct ImDrawData;
struct SDL_Renderer;
struct SDL_Texture;

namespace rastrum::cli::window {

/// For the current ImGui context. Throws Error{no_device}.
class ImguiFonts {
 public:
  explicit ImguiFonts(SDL_Renderer* renderer);
  ~ImguiFonts();
  ImguiFonts(const ImguiFonts&) = delete;
  ImguiFonts& operator=(const ImguiFonts&) = delete;

 private:
  SDL_Texture* texture_;
};

/// Draws the lists of ImGui::Render() over the picture.
void draw_imgui(SDL_Renderer* renderer, const ImDrawData& data);

}  // namespace rastrum::cli::window
