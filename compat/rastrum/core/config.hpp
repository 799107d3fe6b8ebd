#pragma once
#include <rastrum/config.hpp>
