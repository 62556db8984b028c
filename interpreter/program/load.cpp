#include "interpreter/program/load.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "interpreter/stl/document.hpp"
#include "interpreter/stl/encoding.hpp"

namespace s7200 {
namespace {

/// More than any program; devices such as /dev/zero have no end at all.
constexpr std::size_t kLargestFile = 64 << 20;

bool is_instruction(std::string_view mnemonic, std::size_t operands) {
  const Instruction* instruction = find_instruction(mnemonic);
  return instruction && (instruction->operands == operands || !instruction->body);
}

}  // namespace

std::optional<std::string> read_file(const std::string& path, std::string& why) {
  if (std::filesystem::is_directory(path)) {
    why = "it is a folder";
    return {};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    why = std::strerror(errno);
    return {};
  }
  std::string bytes;
  std::array<char, 65536> piece{};
  while (in.read(piece.data(), piece.size()), in.gcount() > 0) {
    bytes.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > kLargestFile) {
      why = fmt::format("it is larger than {} MB", kLargestFile >> 20);
      return {};
    }
  }
  if (in.bad()) {
    why = std::strerror(errno);
    return {};
  }
  return bytes;
}

std::optional<SourceText> read_source(std::string_view bytes, const std::string& name, std::string& why,
                                      bool force_document) {
  const auto decoded = stl::decode(bytes, why);
  if (!decoded) return {};
  const bool as_document = force_document || stl::is_document(decoded->text, is_instruction);
  return SourceText{as_document ? stl::read_document(decoded->text, name, is_instruction) : stl::parse(decoded->text, name),
                    decoded->encoding, as_document};
}

CheckResult check_text(std::string_view utf8, const std::string& name, const CpuModel& model, const TimeTable& times) {
  return check(stl::parse(utf8, name), model, times);
}

}  // namespace s7200
