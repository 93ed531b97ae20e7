// SPDX-License-Identifier: GPL-3.0-or-later
// Good inputs made by the project's own writers and by the libraries whose formats are read: binary ones, too large or too
// perishable for the corpus folder.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "simulation/simulation.hpp"

namespace gdesp::fuzz {

using Seeds = std::vector<std::pair<std::string, std::string>>;  ///< file name, bytes

Seeds raster_seeds(const std::string& folder);  ///< GeoTIFF, plain and compressed
Seeds mesh_seeds(const std::string& folder);    ///< binary STL and PLY
Seeds frame_seeds(const std::string& folder);   ///< fluid and grains as VTP; OpenVDB points
Seeds triangle_seeds(const std::string& folder);
Seeds case_seeds(const std::string& folder);  ///< the files of folder/good.case, which is left there
Seeds record_seeds(
    const std::string& folder);  ///< what gdesp-run writes to a pipe; its frames and folder/good.case are left there
Seeds checkpoint_seeds(const std::string& folder);

constexpr std::uint64_t checkpoint_fingerprint = 1;
SimulationInput small_tank();
/// The bytes with size and checksum at their end made to fit.
std::string with_sound_trailer(std::string bytes);
std::string small_scene();

}  // namespace gdesp::fuzz
