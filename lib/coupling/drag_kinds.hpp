// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
namespace gdesp::coupling {
enum class Drag { ergun_wen_yu, di_felice };
}
