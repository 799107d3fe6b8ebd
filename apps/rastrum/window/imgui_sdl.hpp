// SPDX-License-Identifier: BSD-3-Clause
// Draws Dear ImGui's lists with SDL_Renderer, so that no OpenGL is needed. ImGui's own file for
// that is in Debian's package only as an example, which systems without /usr/share/doc do not have.
#pragma once

struct ImDrawData;
struct SDL_Renderer;
struct SDL_Texture;

namespace rastrum::cli::window {

/// The texture of ImGui's fonts, made for the current ImGui context. Throws Error{no_device}.
class ImguiFonts {
 public:
  explicit ImguiFonts(SDL_Renderer* renderer);
  ~ImguiFonts();
  ImguiFonts(const ImguiFonts&) = delete;
  ImguiFonts& operator=(const ImguiFonts&) = delete;

 private:
  SDL_Texture* texture_;
};

/// Draws the lists that ImGui::Render() has collected over the picture that is there.
void draw_imgui(SDL_Renderer* renderer, const ImDrawData& data);

}  // namespace rastrum::cli::window
