#pragma once
/// The groups on which elements move. Each is a type with the same names, so that kernels are written once.
#include "bough/motion/group_se2.hpp"
#include "bough/motion/group_se3.hpp"
