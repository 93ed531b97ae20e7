// SPDX-License-Identifier: GPL-3.0-or-later
// The one qualifier macro of the project: a function that both back ends compile.
#pragma once

#if defined(__CUDACC__)
#define GDESP_HD __host__ __device__
#else
#define GDESP_HD
#endif
