// SPDX-License-Identifier: GPL-3.0-or-later
// Included before each kernel source that is compiled for the emulated device: from here on the compiler takes the paths
// that nvcc takes for the device.
#pragma once

// What must not see the macros below.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define __CUDACC__ 1
#include <cuda_runtime.h>

// Roots and quotients are one instruction each, written in the device's assembler: the processor's are taken instead.
#include "core/real.hpp"
#define __CUDA_ARCH__ 900
