// Values for the `${…}` of scenarios: those a file has itself, and those that were given from outside.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "tools/scenario/reading/calculation.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

struct ParameterName {
  std::string name;
  stl::Position position{};
};

/// Values for the `${…}` of scenarios that were given from outside: a YAML map, of maps, lists and scalars.
struct GivenParameters {
  std::shared_ptr<const stl::SourceLines> source{};
  Parameters parameters{};
  std::vector<ParameterName> names{};

  /// A rule of a conformance suite that is known to fail, and why.
  struct ExpectedFailure {
    ParameterName rule;
    std::string reason;
  };
  std::vector<ExpectedFailure> expected_failures{};
};

/// `expected_failures` in it are rules and reasons, not parameters. `program` and `times` are paths, relative to the
/// folder of `path`, and come out as paths that can be opened. Nothing, and `diagnostics` for the text of `path`, if it has
/// errors.
std::optional<GivenParameters> read_parameters(const std::string& text, const std::string& path,
                                               stl::Diagnostics& diagnostics);

/// Takes over what a tree says: a.b for maps in maps. Adds the names in the order they stand there.
void read_parameter_tree(const YamlNode& map, Parameters& parameters, std::vector<ParameterName>& names,
                         Complaints& complaints);

}  // namespace s7200::tools
