#pragma once
#include <rastrum/on_terrain.hpp>
