#pragma once
#include <rastrum/transform.hpp>
