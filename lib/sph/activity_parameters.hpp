// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace gdesp::sph {

/// When water sleeps (sph/activity.hpp).
struct ActivityParameters {
  bool sleep = false;               ///< still water sleeps
  double wake_speed = 0.01;         ///< sqrt(g dp): mean velocity of the water in a block
  double splash_speed = 0.3;        ///< sqrt(g dp): of one particle; a hundredth of it for walls
  double start_acceleration = 0.2;  ///< g: mean acceleration of the water in a block at the start
  int halo = 2;                     ///< blocks
  bool near_walls = true;           ///< wall particles away from (awake) water are not touched
  double settle_time = 0.0;         ///< s from the start during which all water is awake
  double rest_time = 0.0;           ///< s that a block stays awake when nothing disturbs it
};

}  // namespace gdesp::sph
