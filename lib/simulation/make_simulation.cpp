// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.hpp"
#include "exec/backend.hpp"
#include "simulation/simulation.hpp"

namespace gdesp {

template <class Exec>
std::unique_ptr<Simulation> make_simulation_on(const Exec& exec, const SimulationInput& input);

std::string resolve_device(const std::string& device) {
  if (device == "auto") return exec::cuda_devices().empty() ? "cpu" : "cuda:0";
  if (device == "cuda") return "cuda:0";
  const bool numbered = device.rfind("cuda:", 0) == 0 && device.size() > 5 &&
                        device.find_first_not_of("0123456789", 5) == std::string::npos;
  if (device != "cpu" && !numbered) {
    throw Error(ErrorKind::usage, "device '" + device + "' is not known; valid are auto, cpu, cuda, cuda:N");
  }
  return device;
}

std::unique_ptr<Simulation> make_simulation(const SimulationInput& input, const std::string& device) {
  const std::string resolved = resolve_device(device);
  if (resolved == "cpu") return make_simulation_on(exec::OpenMP{}, input);
  const exec::Cuda cuda = exec::take_cuda_device(std::stoi(resolved.substr(5)));
#if defined(GDESP_HAVE_CUDA)
  return make_simulation_on(cuda, input);
#else
  (void)cuda;
  return nullptr;  // take_cuda_device has thrown
#endif
}

}  // namespace gdesp
