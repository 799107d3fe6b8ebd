#pragma once
#include <rastrum/fit.hpp>
