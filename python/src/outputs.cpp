// SPDX-License-Identifier: BSD-3-Clause
#include "outputs.hpp"

#include <type_traits>

#include <rastrum/error.hpp>
#include <rastrum/raster/context/target_table.hpp>

namespace rastrum::python {
namespace {

/// A picture of the batch in its array: (N, H, W) or (N, H, W, channels), in C order.
template <class T>
ImageView<T> picture(const Output& array, std::size_t number, const FrameOptions& o) {
  const std::size_t pixels = static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height);
  return {static_cast<T*>(array.data()) + number * pixels, o.width, o.height};
}

template <class T>
struct PixelType {
  using Number = float;
  static constexpr int kChannels = sizeof(T) / sizeof(float);
};
template <>
struct PixelType<Rgba8> {
  using Number = std::uint8_t;
  static constexpr int kChannels = 4;
};
template <>
struct PixelType<std::int64_t> {  // if the numbers fit
  using Number = std::int32_t;
  static constexpr int kChannels = 1;
};

template <class T>
OutputKind kind_of(const raster::TargetRow<T>& row) {
  return {row.python, nb::dtype<typename PixelType<T>::Number>(), PixelType<T>::kChannels,
          [row](Targets& t, const Output& array, std::size_t number, const FrameOptions& o) {
            if constexpr (std::is_same_v<T, std::int64_t>)
              if (array.dtype() != nb::dtype<std::int64_t>()) {
                t.*row.narrow = picture<std::int32_t>(array, number, o);
                return;
              }
            t.*row.image = picture<T>(array, number, o);
          }};
}

const std::vector<OutputKind>& kinds() {
  static const std::vector<OutputKind> all = [] {
    std::vector<OutputKind> rows;
    raster::for_each_target([&]<class T>(const raster::TargetRow<T>& row) {
      if constexpr (!std::is_integral_v<T> || std::is_same_v<T, std::int64_t>)
        if (!row.python.empty()) rows.push_back(kind_of(row));
    });
    return rows;
  }();
  return all;
}

}  // namespace

std::vector<Wanted> wanted(const std::map<std::string, Output>& outputs, std::size_t pictures,
                           const FrameOptions& o, std::uint64_t primitives) {
  std::vector<Wanted> all;
  for (const auto& [name, array] : outputs) {
    const OutputKind* kind = nullptr;
    for (const OutputKind& k : kinds())
      if (name == k.name) kind = &k;
    if (kind == nullptr) {
      std::string names;
      for (const OutputKind& k : kinds())
        names += (names.empty() ? "" : ", ") + std::string(k.name);
      throw Error(Errc::invalid_argument,
                  "outputs: there is no " + name + "; take some of " + names);
    }
    const bool ids = kind->type == nb::dtype<std::int32_t>();
    const bool wide = ids && array.dtype() == nb::dtype<std::int64_t>();
    if (array.dtype() != kind->type && !wide)
      throw Error(Errc::invalid_argument,
                  "out[" + name +
                      "]: the array has another type; docs/python_reference.md has the types of "
                      "all outputs");
    if (ids && !wide && primitives > 0x7fffffffU)
      throw Error(Errc::invalid_argument,
                  "out[" + name + "]: " + std::to_string(primitives) + " primitives want int64");
    const std::size_t axes = kind->channels == 1 ? 3 : 4;
    std::int64_t expected[4] = {static_cast<std::int64_t>(pictures), o.height, o.width,
                                kind->channels};
    bool right = array.ndim() == axes;
    for (std::size_t i = 0; right && i < axes; ++i)
      right = static_cast<std::int64_t>(array.shape(i)) == expected[i];
    std::int64_t step = 1;
    for (std::size_t i = axes; right && i-- > 0; step *= expected[i])
      right = expected[i] == 1 || array.stride(i) == step;
    if (!right)
      throw Error(Errc::invalid_argument,
                  "out[" + name + "]: must be C-contiguous, of shape (" + std::to_string(pictures) +
                      ", " + std::to_string(o.height) + ", " + std::to_string(o.width) +
                      (kind->channels == 1 ? ")" : ", " + std::to_string(kind->channels) + ")"));
    all.push_back({kind, array});
  }
  return all;
}

void bind_outputs(nb::module_& m) {
  nb::list rows;
  for (const OutputKind& k : kinds()) {
    const char* const type = k.type == nb::dtype<float>()          ? "float32"
                             : k.type == nb::dtype<std::int32_t>() ? "int32"
                                                                   : "uint8";
    rows.append(nb::make_tuple(nb::str(k.name.data(), k.name.size()), type, k.channels));
  }
  m.attr("OUTPUTS") = rows;
}

}  // namespace rastrum::python
