// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.hpp"

#include <filesystem>

namespace gdesp::tool {
namespace {

namespace po = boost::program_options;

const char* const usage =
    "mesh2particles SCENE.toml [-o DIR.case] [options]\n"
    "mesh2particles --check FILE...\n"
    "Turns a scene of terrain, water, slides and walls into particles: a case that gdesp-run runs. Ends with one "
    "record\n"
    "(NDJSON) on stdout that names the case.";

const char* const example =
    "Example: mesh2particles lake.toml -o lake.case --set resolution.dp=4 | gdesp-run - -o lake.run\n";

std::string default_output(const std::string& scene) { return std::filesystem::path(scene).stem().string() + ".case"; }

}  // namespace

std::optional<MeshOptions> parse_options(const std::vector<std::string>& arguments) {
  po::options_description own("Options"), hidden, all;
  own.add_options()("output,o", po::value<std::string>()->value_name("DIR.case"),
                    "case folder to write; default: the scene's name with .case, here")(
      "set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
      "overrides a key of the scene, e.g. resolution.dp=0.01; may be repeated")("force", "replace a case that exists")(
      "check",
      "judge meshes and rasters: what is wrong, what repair would do; builds nothing; exit 3 when one is refused")(
      "explain", "say what would be built (counts, memory, steps, cost), and build nothing")(
      "preview", po::value<std::string>()->value_name("FILE.png|vtp"), "draw what was built");
  hidden.add_options()("input", po::value<std::vector<std::string>>(), "");
  const po::options_description common = cli::common_options();
  po::options_description shown;
  shown.add(own).add(common);
  all.add(own).add(common).add(hidden);
  po::positional_options_description positional;
  positional.add("input", -1);
  const po::variables_map vm = cli::parse(arguments, all, positional);
  if (cli::answer_help_or_version(vm, usage, shown, example)) return std::nullopt;
  cli::apply_common(vm);
  MeshOptions o;
  const auto inputs = vm.count("input") ? vm["input"].as<std::vector<std::string>>() : std::vector<std::string>{};
  if (inputs.empty()) throw Error(ErrorKind::usage, "no input; expected SCENE.toml, or --check FILE... (see --help)");
  if (vm.count("check")) {
    o.check = inputs;
    return o;
  }
  if (inputs.size() > 1)
    throw Error(ErrorKind::usage, "one scene at a time; found \"" + inputs[0] + "\" and \"" + inputs[1] + "\"");
  o.scene = inputs.front();
  o.output = vm.count("output") ? vm["output"].as<std::string>() : default_output(o.scene);
  if (vm.count("set")) {
    for (const auto& text : vm["set"].as<std::vector<std::string>>()) o.overrides.push_back(cli::parse_override(text));
  }
  if (vm.count("preview")) {
    o.preview = vm["preview"].as<std::string>();
    const std::string e = std::filesystem::path(o.preview).extension().string();
    if (e != ".png" && e != ".vtp")
      throw Error(ErrorKind::usage, "--preview " + o.preview + ": expected a name ending in .png or .vtp");
  }
  o.force = vm.count("force") > 0;
  o.explain = vm.count("explain") > 0;
  return o;
}

}  // namespace gdesp::tool
