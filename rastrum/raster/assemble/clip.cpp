#include <rastrum/raster/assemble/clip-inl.hpp>
