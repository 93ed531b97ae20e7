// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
namespace gdesp::sph {
enum class Viscosity { none, morris, artificial };
}
