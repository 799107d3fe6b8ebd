#pragma once
#include <rastrum/program.hpp>
