// The common part of PC1000 LAN and Westnet II for a master: blocks of words, bits, retest.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tools/master/words.hpp"

namespace s7200::tools {

using westinghouse::DataCheck;

/// The option that says what the check of a block is.
ProtocolOption data_check_option();

class BlockRequest final : public ProtocolRequest {
 public:
  struct About {
    bool raw = false;
    bool sync = false;  ///< the line has a sync signal
    DataCheck check = DataCheck::Sum;
    std::string subject{};                 ///< `words 16#1234…1235`
    std::optional<std::uint16_t> first{};  ///< address of the first word
    std::size_t count = 0;                 ///< words that are read, or written
    std::string done{};                    ///< what a right answer without values says
  };

  BlockRequest(const Bytes& message, About about) : frame_(serial::to_frame(message)), about_(std::move(about)) {}
  BlockRequest(serial::Frame frame, About about) : frame_(std::move(frame)), about_(std::move(about)) {}

  serial::Frame frame() override { return frame_; }
  bool with_sync() const override { return about_.sync; }
  serial::Answer judge(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) const override;
  std::string_view error_name(std::uint16_t code) const override;
  std::string subject() const override { return about_.subject; }
  std::string in_short(const serial::Answer& answer, std::span<const std::uint8_t> request,
                       std::span<const std::uint8_t> response) const override;
  std::vector<std::string> in_lines(const serial::Answer& answer, std::span<const std::uint8_t> request,
                                    std::span<const std::uint8_t> response) const override;
  nlohmann::ordered_json subject_json(std::span<const std::uint8_t> request) const override;
  nlohmann::ordered_json decoded_json(const serial::Answer& answer) const override { return answer.values; }

 private:
  serial::Frame frame_;
  About about_;
};

/// A parser of the verbs that both protocols have.
class BlockParser : public WordParser {
 public:
  BlockParser(const ProtocolUse& use, bool sync);
  virtual ~BlockParser() = default;

  void read(const Words& operands);
  void write(const Words& operands);
  void set(const Words& operands) { write_bits(operands, true); }
  void reset(const Words& operands) { write_bits(operands, false); }
  void retest(const Words& operands);
  void raw(const Words& operands);

 protected:
  virtual void add(const Bytes& message, BlockRequest::About about);

 private:
  void write_bits(const Words& operands, bool on);

  bool sync_;
  DataCheck check_;
};

/// The table rows of those verbs, for a parser derived from it. `reads` is the help beside `read`.
template <class Parser>
constexpr std::array<Verb<Parser>, 7> block_verbs(std::string_view reads) {
  return {Verb<Parser>{"read", "ADDRESS[:COUNT]…", reads, 1, kMany, &Parser::read},
          Verb<Parser>{"write", "ADDRESS=VALUE,…", "words: 1234, -5, 16#04D2, 2#1010", 1, kMany, &Parser::write},
          Verb<Parser>{"set", "ADDRESS.BIT…", "one bit of a word, from 0 to 15", 1, kMany, &Parser::set},
          Verb<Parser>{"reset", "ADDRESS.BIT…", "the same", 1, kMany, &Parser::reset},
          Verb<Parser>{"retest", "", "in stop the PLC clears its fault register and tests itself", 0, 0, &Parser::retest},
          Verb<Parser>{"raw", "HEX…", "messages as they are", 1, kMany, &Parser::raw},
          Verb<Parser>{"wait", "TIME", "before the next action", 1, 1, &Parser::wait}};
}

/// Joins two tables into one.
template <class Row, std::size_t M, std::size_t N>
constexpr std::array<Row, M + N> joined(const std::array<Row, M>& first, const std::array<Row, N>& second) {
  std::array<Row, M + N> all{};
  std::copy(first.begin(), first.end(), all.begin());
  std::copy(second.begin(), second.end(), all.begin() + M);
  return all;
}

}  // namespace s7200::tools
