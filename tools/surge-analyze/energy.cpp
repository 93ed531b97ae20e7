// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/energy_measurement.hpp"
#include "command.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_energy(const std::vector<std::string>& arguments) {
  CommandLine line("energy", po::options_description("Energy"));
  const char* definition =
      "Energies by phase and kind (J; J per metre in two dimensions): kinetic sum m v^2/2; rotation sum I w^2/2;\n"
      "potential sum m g z, counted from the first frame; compression of the water along Tait's law (Monaghan 1994,\n"
      "J. Comput. Phys. 110, 399, doi 10.1006/jcph.1994.1034), its constant fitted to the frame's p and rho; lost: "
      "what\n"
      "is missing of the first frame's total. Rigid bodies are not counted: their mass is not in the frames.\n";
  if (!line.parse(arguments, definition, "surge-analyze energy lake.run --plot energy.svg")) return 0;
  analysis::EnergyMeasurement measurement;
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
