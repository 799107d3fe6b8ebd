#pragma once
#include <rastrum/mesh.hpp>
