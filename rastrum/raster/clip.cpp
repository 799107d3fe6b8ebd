#include <rastrum/raster/clip-inl.hpp>
