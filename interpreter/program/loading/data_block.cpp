#include "interpreter/program/loading/data_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

class DataPlacing {
 public:
  DataPlacing(const stl::Source& source, const CpuModel& model, stl::Diagnostics& diagnostics)
      : source_(source),
        model_(model),
        diagnostics_(diagnostics),
        bytes_(model.size_of(Area::V)),
        set_by_(bytes_.size(), nullptr) {}

  std::vector<InitialData> result() {
    for (const stl::DataLine& line : source_.data) place(line);
    std::vector<InitialData> runs;
    for (std::uint32_t at = 0; at < bytes_.size(); ++at) {
      if (!set_by_[at]) continue;
      if (at == 0 || !set_by_[at - 1]) runs.push_back({at, {}});
      runs.back().bytes.push_back(bytes_[at]);
    }
    return runs;
  }

 private:
  void error(const stl::Position& at, std::string message, std::string hint = {}, std::string cause = {}) {
    diagnostics_.push_back({stl::Severity::Error, at, std::move(message), std::move(hint), std::move(cause)});
  }

  void place(const stl::DataLine& line) {
    if (line.only_comment()) return;
    const bool first = std::exchange(first_, false);
    if (line.address) {
      width_ = width_of_line(*line.address);
      next_ = width_ ? std::get<stl::Address>(line.address->value).number : 0;
    } else if (first) {
      error(line.position, "the first line of a data block has no address",
            "begin it with the address of its first value, VB0");
    }
    if (!width_) return;
    for (const stl::DataLine::Value& value : line.values) {
      const auto bytes = bytes_of_value(value);
      if (!bytes)
        next_ += bytes_of(*width_);
      else if (!put(*bytes, value.position, line))
        return;
    }
  }

  std::optional<Width> width_of_line(const stl::Operand& written) {
    const auto* address = std::get_if<stl::Address>(&written.value);
    if (const auto* name = std::get_if<stl::Name>(&written.value)) {
      error(written.position,
            name->reason.empty() ? fmt::format("'{}' is neither an address nor a defined symbol", stl::shortened(name->text))
                                 : name->reason,
            "give the symbol table too, or write the address itself", name->reason.empty() ? kUndefinedSymbols : "");
    } else if (!address || address->area != "V") {
      error(written.position, fmt::format("{} is not in V memory", stl::to_text(written)),
            "a data block sets V memory only");
    } else if (address->size == stl::Size::None) {
      error(written.position,
            fmt::format("{} does not say whether it is a byte, word or double word", stl::to_text(written)),
            fmt::format("did you mean VB{}?", address->number));
    } else if (address->size == stl::Size::Bit) {
      error(written.position, fmt::format("{} is a bit", stl::to_text(written)),
            fmt::format("set the whole byte, VB{}", address->number));
    } else {
      return width_of(*address, Area::V);
    }
    return {};
  }

  /// The bytes of a value as they will lie in memory; nothing after a message.
  std::optional<std::string> bytes_of_value(const stl::DataLine::Value& value) {
    const auto refuse = [&](std::string message, std::string hint) {
      error(value.position, std::move(message), std::move(hint));
      return std::nullopt;
    };
    if (const auto* text = std::get_if<stl::Text>(&value.value)) {
      if (*width_ != Width::Byte) return refuse("a text is set from a byte on", "begin the line with VB and its number");
      return text->bytes;
    }
    std::uint32_t bits = 0;
    if (const auto* real = std::get_if<stl::Real>(&value.value)) {
      if (*width_ != Width::Double)
        return refuse("a real number needs a double word", "begin the line with VD and its number");
      bits = std::bit_cast<std::uint32_t>(real->value);
    } else {
      const std::int64_t number = std::get<stl::Integer>(value.value).value;
      const std::int64_t values = std::int64_t{1} << (8 * bytes_of(*width_));
      if (number < -values / 2 || number >= values)
        return refuse(fmt::format("{} does not fit in {}", number, counted(bytes_of(*width_), "byte")),
                      "begin the line with VW for words, with VD for double words");
      bits = static_cast<std::uint32_t>(number);
    }
    std::string bytes;
    for (std::uint32_t shift = 8 * bytes_of(*width_); shift > 0; shift -= 8) bytes += static_cast<char>(bits >> (shift - 8));
    return bytes;
  }

  /// Puts bytes at their place. Returns false after a message.
  bool put(std::string_view bytes, const stl::Position& at, const stl::DataLine& line) {
    if (next_ + bytes.size() > bytes_.size()) {
      error(at,
            fmt::format("the data block runs past the end of V memory: this value is at VB{} and beyond",
                        next_ + bytes.size() - 1),
            fmt::format("V memory of CPU {} is {}{}", model_.name, range_text(model_, Area::V, Width::Byte),
                        larger_cpu(next_ + bytes.size())));
      return false;
    }
    for (const char byte : bytes) {
      if (const stl::DataLine* first = set_by_[next_]; first && first != &line) {
        error(at, fmt::format("VB{} is set twice", next_),
              fmt::format("it is first set in {}", stl::line_text(source_, first->position.line, at.line)));
        return false;
      }
      bytes_[next_] = static_cast<std::uint8_t>(byte);
      set_by_[next_++] = &line;
    }
    return true;
  }

  std::string larger_cpu(std::uint64_t bytes) const {
    const CpuModel* larger = smallest_cpu([&](const CpuModel& model) { return model.size_of(Area::V) >= bytes; });
    return larger ? fmt::format("; CPU {} has enough: --cpu {}", larger->name, larger->name) : "";
  }

  const stl::Source& source_;
  const CpuModel& model_;
  stl::Diagnostics& diagnostics_;
  std::vector<std::uint8_t> bytes_;
  std::vector<const stl::DataLine*> set_by_;
  bool first_ = true;           // line with values
  std::optional<Width> width_;  // of the line that is being placed; nothing after an error
  std::uint64_t next_ = 0;
};

}  // namespace

std::vector<InitialData> place_data(const stl::Source& source, const CpuModel& model, stl::Diagnostics& diagnostics) {
  if (source.data.empty()) return {};
  return DataPlacing(source, model, diagnostics).result();
}

}  // namespace s7200
