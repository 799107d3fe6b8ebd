#include "outputs.hpp"

#include <rastrum/error.hpp>

namespace rastrum::python {
namespace {

/// A picture of a batch in the array that is to hold it: (N, H, W) or (N, H, W, channels), in C
/// order.
template <class T>
ImageView<T> picture(const Output& array, std::size_t number, const FrameOptions& o) {
  const std::size_t pixels = static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height);
  return {static_cast<T*>(array.data()) + number * pixels, o.width, o.height};
}

template <class T, auto member>
void attach(Targets& t, const Output& a, std::size_t n, const FrameOptions& o) {
  t.*member = picture<T>(a, n, o);
}
/// As sensors do, 0 where nothing is.
template <auto member>
void attach_distance(Targets& t, const Output& a, std::size_t n, const FrameOptions& o) {
  t.*member = picture<float>(a, n, o);
  t.no_distance = 0;
}
template <auto wide, auto narrow>
void attach_ids(Targets& t, const Output& a, std::size_t n, const FrameOptions& o) {
  if (a.dtype() == nb::dtype<std::int64_t>())
    t.*wide = picture<std::int64_t>(a, n, o);
  else
    t.*narrow = picture<std::int32_t>(a, n, o);
}

const OutputKind kKinds[] = {
    {"color", nb::dtype<std::uint8_t>(), 4, attach<Rgba8, &Targets::color8>},
    {"color_f32", nb::dtype<float>(), 4, attach<Vec4, &Targets::color>},
    {"depth", nb::dtype<float>(), 1, attach_distance<&Targets::view_depth>},
    {"depth_raw", nb::dtype<float>(), 1, attach<float, &Targets::depth>},
    {"distance", nb::dtype<float>(), 1, attach_distance<&Targets::distance>},
    {"id", nb::dtype<std::int32_t>(), 1, attach_ids<&Targets::ids, &Targets::ids32>},
    {"instance", nb::dtype<std::int32_t>(), 1,
     attach_ids<&Targets::instances, &Targets::instances32>},
    {"face", nb::dtype<std::int32_t>(), 1,
     attach_ids<&Targets::primitives, &Targets::primitives32>},
    {"barycentrics", nb::dtype<float>(), 2, attach<Vec2, &Targets::barycentrics>},
    {"normal", nb::dtype<float>(), 3, attach<Vec3, &Targets::normals>},
    {"camera_normal", nb::dtype<float>(), 3, attach<Vec3, &Targets::camera_normals>},
    {"position", nb::dtype<float>(), 3, attach<Vec3, &Targets::positions>},
    {"albedo", nb::dtype<float>(), 4, attach<Vec4, &Targets::albedo>},
    {"linear", nb::dtype<float>(), 4, attach<Vec4, &Targets::linear>},
    {"scalars", nb::dtype<float>(), 1, attach<float, &Targets::scalars>},
};

}  // namespace

/// Checks type and shape of what is to be filled.
std::vector<Wanted> wanted(const std::map<std::string, Output>& outputs, std::size_t pictures,
                           const FrameOptions& o, std::uint64_t primitives) {
  std::vector<Wanted> all;
  for (const auto& [name, array] : outputs) {
    const OutputKind* kind = nullptr;
    for (const OutputKind& k : kKinds)
      if (name == k.name) kind = &k;
    if (kind == nullptr) {
      std::string names;
      for (const OutputKind& k : kKinds) names += (names.empty() ? "" : ", ") + std::string(k.name);
      throw Error(Errc::invalid_argument,
                  "outputs: there is no " + name + "; take some of " + names);
    }
    const bool ids = kind->type == nb::dtype<std::int32_t>();
    const bool wide = ids && array.dtype() == nb::dtype<std::int64_t>();
    if (array.dtype() != kind->type && !wide)
      throw Error(
          Errc::invalid_argument,
          "out[" + name +
              "]: the array is of another type; docs/python.md has the types of all outputs");
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

}  // namespace rastrum::python
