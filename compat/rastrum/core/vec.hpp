#pragma once
#include <rastrum/vec.hpp>
