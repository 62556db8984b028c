#include "tools/faces/dap/attributes.hpp"

#include <algorithm>

namespace s7200::tools::dap {
namespace {

using enum AttributeUse;

struct Row {
  std::string_view key;
  AttributeUse use;
};

constexpr Row kAttributes[] = {
    {"stopOnEntry", Session},
    {"noDebug", Session},
    {"step", Session},
    {"send", Session},
    {"sendAfter", Session},
    {"station", Session},
    {"token", Session},
    {"cwd", Session},
    {"program", Program},
    // Those of VS Code, Zed (adapter, label, build) and nvim-dap
    {"name", Editor},
    {"type", Editor},
    {"request", Editor},
    {"debugServer", Editor},
    {"preLaunchTask", Editor},
    {"postDebugTask", Editor},
    {"presentation", Editor},
    {"serverReadyAction", Editor},
    {"internalConsoleOptions", Editor},
    {"debugOptions", Editor},
    {"suppressMultipleSessionWarning", Editor},
    {"adapter", Editor},
    {"label", Editor},
    {"build", Editor},
    // What templates for programs of the computer have
    {"env", OfOthers},
    {"envFile", OfOthers},
    {"environment", OfOthers},
    {"args", OfOthers},
    {"console", OfOthers},
    {"externalConsole", OfOthers},
    {"integratedTerminal", OfOthers},
    {"runInTerminal", OfOthers},
    {"terminal", OfOthers},
    {"host", OfOthers},
    {"restart", OfOthers},
    {"linux", OfOthers},
    {"osx", OfOthers},
    {"macos", OfOthers},
    {"windows", OfOthers},
    {"runtimeExecutable", OfOthers},
    {"runtimeArgs", OfOthers},
    {"justMyCode", OfOthers},
    {"showLog", OfOthers},
    {"sourceMap", OfOthers},
    {"sourceMaps", OfOthers},
    {"sourceLanguages", OfOthers},
    {"pathMappings", OfOthers},
    {"outFiles", OfOthers},
    {"skipFiles", OfOthers},
    {"smartStep", OfOthers},
};

}  // namespace

AttributeUse use_of(std::string_view key) {
  if (key.starts_with("__")) return Editor;  // as VS Code marks what is its own
  const auto* const row = std::ranges::find(kAttributes, key, &Row::key);
  return row == std::end(kAttributes) ? Program : row->use;
}

}  // namespace s7200::tools::dap
