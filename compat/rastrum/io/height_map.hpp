#pragma once
#include <rastrum/io.hpp>
