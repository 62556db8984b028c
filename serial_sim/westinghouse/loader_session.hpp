// Sessions of the PC500 and PC2000 loader port: one operation, byte by byte in a handshake.
//
//   computer  02        opcode    DLE ACK          DLE ACK, arguments, DLE EOT            DLE ACK
//   PLC          DLE ACK       02         16 DLE ETX                           DLE ACK 02
//
//   and if there is data:            data, DLE ETX          02           12 DLE ETX
//                            DLE ACK               DLE ACK      DLE ACK              DLE ACK
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/peers/answer.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {

enum class LoaderOpcode : std::uint8_t { Write = 0x03, Read = 0x04, Pointers = 0x18, Block = 0x1A, Directory = 0x1B };

/// Whether the PLC doubles a data byte 10 in its answers [S3]; the computer always does.
enum class Dle : std::uint8_t { Doubled, Plain };
inline constexpr auto kDleWords = words_of<Dle>({{Dle::Doubled, "doubled"}, {Dle::Plain, "plain"}});

/// The block whose address is the first of the block directory [S1].
enum class FirstBlock : std::uint8_t { Db0, Db1 };
inline constexpr auto kFirstBlockWords = words_of<FirstBlock>({{FirstBlock::Db0, "db0"}, {FirstBlock::Db1, "db1"}});

inline constexpr std::uint8_t kStx = 0x02, kEtx = 0x03, kEot = 0x04, kAck = 0x06, kDle = 0x10, kNak = 0x15;
inline constexpr std::uint8_t kHeader = 0x16, kEnd = 0x12;
inline constexpr std::uint8_t kDataBlocks = 0x01;  ///< type of block
inline constexpr std::size_t kMostLoaderBytes = 512;
inline constexpr std::size_t kReadHead = 5;  ///< 00 bytes before the data of a read

inline constexpr std::string_view kRefusalName = "refused (NAK)";
inline constexpr std::array kRefusal{kDle, kNak}, kEndOfArguments{kDle, kEot}, kEndOfData{kDle, kEtx};

/// The steps of a session in their order. The computer begins, and the two take turns.
enum class LoaderStep : std::uint8_t {
  Begin,
  BeginHeard,
  Opcode,
  Ready,
  Header,
  HeaderHeard,
  Arguments,
  ArgumentsHeard,
  DataWanted,
  DataSent,
  DataHeard,
  EndReady,
  EndWanted,
  End,
  Close
};

inline bool is_of_plc(LoaderStep step) { return static_cast<unsigned>(step) % 2 == 1; }

/// The step after this one, which is not the last; a session without data goes on at its end after the arguments.
LoaderStep after(LoaderStep step, bool with_data);

/// The fixed bytes of a step, or those in front of its arguments; empty for an opcode and for data.
Bytes fixed(LoaderStep step);

/// The operation of a session.
struct LoaderOperation {
  LoaderOpcode opcode = LoaderOpcode::Read;
  Bytes arguments{};
  std::size_t data = 0;          ///< bytes that come back; 0 for a write
  bool more_may_follow = false;  ///< after the data; nothing about it is documented
};

bool has_data(LoaderOpcode opcode);
bool is_loader_opcode(std::uint8_t byte);

LoaderOperation loader_read(std::uint16_t first, std::size_t count);
LoaderOperation loader_write(std::uint16_t first, std::span<const std::uint8_t> data);
LoaderOperation loader_pointers();
LoaderOperation loader_block(std::uint8_t number);
LoaderOperation loader_directory();

/// The bytes with each 10 doubled.
Bytes stuffed(std::span<const std::uint8_t> bytes);

/// The bytes with each doubled 10 taken back; a 10 that is not doubled stays.
Bytes unstuffed(std::span<const std::uint8_t> bytes);

bool begins_with(std::span<const std::uint8_t> text, std::span<const std::uint8_t> beginning);

/// The computer's part of a session, step by step.
class LoaderSteps {
 public:
  LoaderSteps(LoaderOperation operation, Dle dle) : operation_(std::move(operation)), dle_(dle) {}

  /// Begins a session anew, with 02.
  Bytes first();

  /// The bytes to send after `response`. Nothing if the session is over, or the response does not fit.
  std::optional<Bytes> next(std::span<const std::uint8_t> response);

  /// Whether this step is answered: the last one is not.
  bool answered() const { return step_ != LoaderStep::Close; }

  /// Judges all that a PLC answered in a session. `bytes` of the result is the data. An exception 15 is a refusal.
  serial::Answer judge(std::span<const std::uint8_t> response) const;

  const LoaderOperation& operation() const { return operation_; }

 private:
  /// The number of bytes of `response` that are this step of the PLC; nothing if it does not fit. The data goes to `data`.
  std::optional<std::size_t> length_of(LoaderStep step, std::span<const std::uint8_t> response, Bytes& data) const;
  bool has_all(std::size_t bytes) const;
  std::optional<std::size_t> take_data(std::span<const std::uint8_t> response, Bytes& data) const;
  LoaderStep after(LoaderStep step) const { return westinghouse::after(step, has_data(operation_.opcode)); }
  int answers() const { return has_data(operation_.opcode) ? 7 : 5; }

  LoaderOperation operation_;
  Dle dle_;
  LoaderStep step_ = LoaderStep::Begin;  // that was sent last
};

/// Whether the PLC waits for the computer after these bytes.
bool is_whole_step(std::span<const std::uint8_t> response);

}  // namespace s7200::westinghouse
