#pragma once
#include <rastrum/shapes.hpp>
