#include <rastrum/raster/rules/clip_code.hpp>
