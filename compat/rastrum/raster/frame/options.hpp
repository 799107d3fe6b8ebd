#pragma once
#include <rastrum/frame.hpp>
#include <rastrum/tuning.hpp>
