#pragma once
#include <rastrum/error.hpp>
