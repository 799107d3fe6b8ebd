#pragma once
#include <rastrum/terrain.hpp>
