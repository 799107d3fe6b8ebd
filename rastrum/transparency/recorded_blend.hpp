// SPDX-License-Identifier: BSD-3-Clause
// Also sends its layers to the FragmentSink of the frame, as many per pixel as the method looks at.
#pragma once

#include <rastrum/raster/context/fragment_sink.hpp>
#include <rastrum/transparency/blend.hpp>

namespace rastrum::transparency {

class RecordedBlend final : public LayerBlend {
 public:
  /// Both must outlive its use.
  void begin(LayerBlend& method, raster::FragmentSink& sink) {
    method_ = &method;
    sink_ = &sink;
  }
  void place(int bx, int by) {
    bx_ = bx;
    by_ = by;
  }

  [[nodiscard]] LayerOrder order() const override { return method_->order(); }
  [[nodiscard]] int passes() const override { return method_->passes(); }
  [[nodiscard]] float opaque_at() const override { return method_->opaque_at(); }
  void begin(const raster::BlockColors& behind) override { method_->begin(behind); }
  void begin_pass(int pass) override { method_->begin_pass(pass); }
  std::uint64_t layer(const Layer& layer) override {
    sink_->take({bx_, by_, layer.keys, layer.mask, &layer.colors});
    return method_->layer(layer);
  }
  void finish(raster::BlockColors& out) override { method_->finish(out); }

 private:
  LayerBlend* method_ = nullptr;
  raster::FragmentSink* sink_ = nullptr;
  int bx_ = 0, by_ = 0;
};

}  // namespace rastrum::transparency
