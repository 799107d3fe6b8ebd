#pragma once
#include <rastrum/render.hpp>
