#pragma once
#include <rastrum/mat.hpp>
