// Values for the `${…}` of scenarios: those a file has itself, and those that were given from outside.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "tools/scenario/calculation.hpp"
#include "tools/scenario/yaml.hpp"

namespace s7200::tools {

/// What goes wrong in one file. A mistake in a loop is made in every turn of it and told once, as is one that was found
/// before, by the parser of YAML.
class Complaints {
 public:
  explicit Complaints(stl::Diagnostics& list);
  void add(const YamlNode& node, std::string message, std::string hint = {});
  std::size_t count() const { return list_.size(); }

 private:
  stl::Diagnostics& list_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> known_;
};

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

/// A path in a file: from the folder of that file.
std::string beside(const std::string& file, const std::string& path);

}  // namespace s7200::tools
