#pragma once
#include <rastrum/stop.hpp>
