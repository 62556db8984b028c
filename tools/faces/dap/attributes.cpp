#include "tools/faces/dap/attributes.hpp"

#include <algorithm>

namespace s7200::tools::dap {
namespace {

struct AttributeRow {
  std::string_view key;
  AttributeUse use;
};

constexpr AttributeRow kAttributes[] = {
    {"stopOnEntry", AttributeUse::Session},
    {"noDebug", AttributeUse::Session},
    {"step", AttributeUse::Session},
    {"send", AttributeUse::Session},
    {"sendAfter", AttributeUse::Session},
    {"station", AttributeUse::Session},
    {"token", AttributeUse::Session},
    {"cwd", AttributeUse::Session},
    {"program", AttributeUse::Program},
    {"with", AttributeUse::Program},
    // Those of VS Code, Zed (adapter, label, build) and nvim-dap
    {"name", AttributeUse::Editor},
    {"type", AttributeUse::Editor},
    {"request", AttributeUse::Editor},
    {"debugServer", AttributeUse::Editor},
    {"preLaunchTask", AttributeUse::Editor},
    {"postDebugTask", AttributeUse::Editor},
    {"presentation", AttributeUse::Editor},
    {"serverReadyAction", AttributeUse::Editor},
    {"internalConsoleOptions", AttributeUse::Editor},
    {"debugOptions", AttributeUse::Editor},
    {"suppressMultipleSessionWarning", AttributeUse::Editor},
    {"adapter", AttributeUse::Editor},
    {"label", AttributeUse::Editor},
    {"build", AttributeUse::Editor},
    // What templates for programs of the computer have
    {"env", AttributeUse::OfOthers},
    {"envFile", AttributeUse::OfOthers},
    {"environment", AttributeUse::OfOthers},
    {"args", AttributeUse::OfOthers},
    {"console", AttributeUse::OfOthers},
    {"externalConsole", AttributeUse::OfOthers},
    {"integratedTerminal", AttributeUse::OfOthers},
    {"runInTerminal", AttributeUse::OfOthers},
    {"terminal", AttributeUse::OfOthers},
    {"host", AttributeUse::OfOthers},
    {"restart", AttributeUse::OfOthers},
    {"linux", AttributeUse::OfOthers},
    {"osx", AttributeUse::OfOthers},
    {"macos", AttributeUse::OfOthers},
    {"windows", AttributeUse::OfOthers},
    {"runtimeExecutable", AttributeUse::OfOthers},
    {"runtimeArgs", AttributeUse::OfOthers},
    {"justMyCode", AttributeUse::OfOthers},
    {"showLog", AttributeUse::OfOthers},
    {"sourceMap", AttributeUse::OfOthers},
    {"sourceMaps", AttributeUse::OfOthers},
    {"sourceLanguages", AttributeUse::OfOthers},
    {"pathMappings", AttributeUse::OfOthers},
    {"outFiles", AttributeUse::OfOthers},
    {"skipFiles", AttributeUse::OfOthers},
    {"smartStep", AttributeUse::OfOthers},
};

}  // namespace

AttributeUse use_of(std::string_view key) {
  if (key.starts_with("__")) return AttributeUse::Editor;  // as VS Code marks what is its own
  const auto* const row = std::ranges::find(kAttributes, key, &AttributeRow::key);
  return row == std::end(kAttributes) ? AttributeUse::Program : row->use;
}

}  // namespace s7200::tools::dap
