// How the approximations go through a layer of a block, in lanes of pixels or in one float. Include
// it in a namespace that has kLanes, kVector (as many bits) and lanes_of (a mask).

/// Calls f(first pixel, lanes) for the vectors that hold any pixel of the layer.
template <class Each>
RASTRUM_LANES void for_each_part(const Layer& layer, const Each& f) {
  for (std::size_t i = 0; i < 64; i += kLanes)
    if ((layer.mask >> i & kVector) != 0) f(i, lanes_of(layer.mask >> i));
}
