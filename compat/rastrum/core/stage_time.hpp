#pragma once
#include <rastrum/device.hpp>
