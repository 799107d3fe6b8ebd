#include <rastrum/raster/rules/clip-inl.hpp>
