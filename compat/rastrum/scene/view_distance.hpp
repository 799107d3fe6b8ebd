#pragma once
#include <rastrum/camera.hpp>
