// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"

namespace gdesp::tool {

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      {"runup", "climb height above still water against time, per bank; its maximum along the shore", run_runup},
      {"front", "leading edge of water and solids against time, also as x*, t*", run_front},
      {"profile", "surface of water and slide along a line at given times", run_profile},
      {"gauge", "water level and pressure at points against time; arrival times", run_gauge},
      {"render", "one picture in three dimensions: terrain, water by speed, slide", run_render},
  };
  return all;
}

}  // namespace gdesp::tool
