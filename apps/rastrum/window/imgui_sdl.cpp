// SPDX-License-Identifier: BSD-3-Clause
#include "imgui_sdl.hpp"

#include <SDL.h>
#include <imgui.h>

#include <string>

#include <rastrum/error.hpp>

namespace rastrum::cli::window {

ImguiFonts::ImguiFonts(SDL_Renderer* renderer) {
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.GetTexDataAsRGBA32(&pixels, &width, &height);
  texture_ =
      SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
  if (texture_ == nullptr ||
      SDL_UpdateTexture(texture_, nullptr, pixels, width * static_cast<int>(sizeof(Uint32))) != 0 ||
      SDL_SetTextureBlendMode(texture_, SDL_BLENDMODE_BLEND) != 0)
    throw Error(Errc::no_device,
                std::string("the window's fonts cannot be drawn: ") + SDL_GetError());
  fonts.SetTexID(texture_);
}

ImguiFonts::~ImguiFonts() {
  ImGui::GetIO().Fonts->SetTexID(nullptr);
  SDL_DestroyTexture(texture_);
}

void draw_imgui(SDL_Renderer* renderer, const ImDrawData& data) {
  constexpr int kStride = sizeof(ImDrawVert);
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) {
        if (command.UserCallback != ImDrawCallback_ResetRenderState)
          command.UserCallback(&list, &command);
        continue;
      }
      const SDL_FRect clip{
          command.ClipRect.x - data.DisplayPos.x, command.ClipRect.y - data.DisplayPos.y,
          command.ClipRect.z - command.ClipRect.x, command.ClipRect.w - command.ClipRect.y};
      const SDL_Rect pixels{static_cast<int>(clip.x), static_cast<int>(clip.y),
                            static_cast<int>(clip.w), static_cast<int>(clip.h)};
      // SDL takes an empty rectangle for none.
      if (pixels.w <= 0 || pixels.h <= 0) continue;
      SDL_RenderSetClipRect(renderer, &pixels);
      const ImDrawVert* const vertices = list.VtxBuffer.Data + command.VtxOffset;
      const ImDrawIdx* const indices = list.IdxBuffer.Data + command.IdxOffset;
      SDL_RenderGeometryRaw(
          renderer, static_cast<SDL_Texture*>(command.GetTexID()), &vertices->pos.x, kStride,
          reinterpret_cast<const SDL_Color*>(&vertices->col), kStride, &vertices->uv.x, kStride,
          list.VtxBuffer.Size - static_cast<int>(command.VtxOffset), indices,
          static_cast<int>(command.ElemCount), sizeof(ImDrawIdx));
    }
  }
  SDL_RenderSetClipRect(renderer, nullptr);
}

}  // namespace rastrum::cli::window
