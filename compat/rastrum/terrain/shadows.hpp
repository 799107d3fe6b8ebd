#pragma once
#include <rastrum/terrain_light.hpp>
