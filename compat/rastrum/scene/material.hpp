#pragma once
#include <rastrum/scene.hpp>
