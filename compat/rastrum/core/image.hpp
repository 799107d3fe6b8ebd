#pragma once
#include <rastrum/image.hpp>
