// What S7 requests and their answers are made of, as PPI carries them: codes that both ends know (facts 10.9).
//
//   request  32 01 00 00 number(2) length of parameters(2) length of data(2) parameters data
//   answer   32 03 00 00 number(2) length of parameters(2) length of data(2) error(2) parameters data
//   variable in the parameters of a read or write: 12 0A 10 type count(2) block(2) area address(3); V memory is block 1
//   value in the data of an answer to a read: return code, data type, length(2), bytes; each begins at an even place
//
// An element of T stands in data as a status byte and four bytes of value, one of C as a status byte and two: so in
// published recordings of an S7-200 (iottree, of T32…T34 and T40…T43) and in the client library libnodave (five and three
// bytes each).
//
// Forced values go as user data of group 8, services 0B and 0E: a byte that is 00, or 01 to take them back, their number,
// the variables without `12 0A`, then the values, each filled up to an even number of bytes. So 0B stands in published
// requests to an S7-200 (of Q0.0) and to an S7-200 SMART (of VD228, forced with 00 and released with 01). The client library
// libnodave sends 0E, which "sets outputs in STOP" and ends with RUN; there each value has the head of a value that is
// written, `00 04 00 08`, and the length of the list does not count the values.
// Blocks go as user data of group 3 and as functions 1D, 1E and 1F, in the form that the client libraries libnodave and
// snap7 share; their errors are those that libnodave names.
//
// Not documented, modelled so:
// - The status is 02 while the bit of the timer or counter is 1, as in a recording of a timer at 32767, otherwise 00, as of
//   one that runs. What is written has the same form; its status is not looked at.
//   [S7Services.TimersAndCountersHaveAStatusAndTheirCurrentValue]
// - A current value that is written is taken as it is, as MOVW writes it: of a timer 8000 to FFFF too, which it never counts
//   to; it goes on from there as from a negative number. [S7Services.ANegativeCurrentValueOfATimerIsWritten]
// - High-speed counters have area and type 20. [S7Services.HighSpeedCountersAreReadAsDoubleWords]
// - S is area 04, as the client library HslCommunication has it for the S7-200; python-snap7, and facts 10.9
//   after it, have 03 for it, which libnodave and Wireshark call the system information of this family.
//   [S7Services.EachAreaIsReadAtItsPlace]
// - Area 03 has the CPU's identification and nothing else: 16 characters of its name and four digits of its release, as the
//   server of HslCommunication has it ("CPU 226 CN", "0201"). The digits of the CPUs here are a choice: 0200 for release 2,
//   0100 for all before it. It cannot be written. [S7Services.TheIdentificationIsNameAndRelease]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"

namespace s7200::s7 {

inline constexpr std::uint8_t kProtocol = 0x32;
enum Kind : std::uint8_t { kRequest = 1, kAnswer = 3, kUserData = 7 };
inline constexpr std::size_t kRequestHead = 10, kAnswerHead = 12, kLongestPdu = 240;

/// The longest time for which a master asks for the answer to a request that was accepted (a choice:
/// interpreter/cpu/network.hpp).
inline constexpr Time kLongestWork = kSecond;

enum Function : std::uint8_t {
  kRead = 0x04,
  kWrite = 0x05,
  kStartUpload = 0x1D,
  kUpload = 0x1E,
  kEndUpload = 0x1F,
  kRun = 0x28,
  kStop = 0x29,
  kSetup = 0xF0
};

/// The error bytes in the answer to a request that is refused as a whole.
enum class Refusal : std::uint16_t {
  None = 0,
  Unknown = 0x8104,
  TooLong = 0x8500,
  Malformed = 0x8704,
  BlockName = 0xD201,  ///< wrong syntax of the name
  BlockType = 0xD203,
  NoBlock = 0xD209,
  NoBlockOfType = 0xD20E,
  OutOfTurn = 0xD240,  ///< a part or the end of an upload that has not been started
  Protected = 0xD241   ///< as by a password
};

/// The result for one variable.
enum ReturnCode : std::uint8_t { kDone = 0xFF, kNotAllowed = 0x03, kOutside = 0x05, kWrongType = 0x06, kNoArea = 0x0A };

inline constexpr std::size_t kVariableBytes = 12;
inline constexpr std::array<std::uint8_t, 3> kVariableHead{0x12, kVariableBytes - 2, 0x10};

/// The unit in which a variable's count counts. T, C and HC have the code of their area as their type.
enum Type : std::uint8_t { kBit = 1, kByte = 2, kCharacter = 3, kWord = 4, kInteger = 5, kDouble = 6, kLong = 7, kReal = 8 };

/// The width of a type; nothing for a type that the S7-200 does not have, and for T, C and HC.
std::optional<Width> width_of(std::uint8_t type);

/// The unit in which the length of a variable's data counts.
enum DataType : std::uint8_t { kInBits = 3, kInBitsOfBytes = 4, kInBytes = 9 };

/// Bytes before each value in the data of a write: return code, type and length.
inline constexpr std::size_t kValueHead = 4;

/// The number of bytes of a value whose data have this type and length.
std::size_t data_bytes(std::uint8_t type, std::size_t length);

struct WireArea {
  std::uint8_t code;
  Area area;
};
inline constexpr std::array kWireAreas{WireArea{0x04, Area::S},  WireArea{0x05, Area::SM}, WireArea{0x06, Area::AI},
                                       WireArea{0x07, Area::AQ}, WireArea{0x1E, Area::C},  WireArea{0x1F, Area::T},
                                       WireArea{0x20, Area::HC}, WireArea{0x81, Area::I},  WireArea{0x82, Area::Q},
                                       WireArea{0x83, Area::M},  WireArea{0x84, Area::V}};

/// Elements of T, C and HC in data: their values stand at the end of each.
std::uint32_t bytes_of_element(Area area);
inline constexpr std::uint8_t kElementIsOn = 0x02;  ///< status, the first byte of T and C

/// Appends one element; `value` is in the form of the image.
void append_element(Bytes& to, Area area, std::span<const std::uint8_t> value, bool is_on);

/// The values alone, as the image has them; a part of an element at the end is left out.
Bytes element_values(Area area, std::span<const std::uint8_t> data);

/// The types of blocks, in the order in which S7 counts them.
struct BlockType {
  std::uint8_t letter;
  std::string_view name;
};
inline constexpr std::array kBlockTypes{BlockType{'8', "OB"}, BlockType{'E', "FB"},  BlockType{'C', "FC"},
                                        BlockType{'A', "DB"}, BlockType{'B', "SDB"}, BlockType{'D', "SFC"},
                                        BlockType{'F', "SFB"}};
/// Empty for a letter that is none of them.
std::string_view name_of_blocks(std::uint8_t letter);

/// A block as S7 names it: `0A00001A` is 0, the letter of its type, its number, and where it is: linked into the program
/// (A), not linked (P), or either (B), which says nothing here.
struct BlockName {
  std::uint8_t type = 0;
  std::uint32_t number = 0;
};
/// Parses a block's name; nothing if the text is not one.
std::optional<BlockName> block_name_in(std::span<const std::uint8_t> text);
/// The name in the parameters of a start of an upload, after 1D, seven bytes, its length and `_`. Nothing if the length is
/// wrong.
std::optional<std::span<const std::uint8_t>> name_to_upload(std::span<const std::uint8_t> parameters);

/// The number of the data block that is V memory.
inline constexpr std::uint16_t kBlockOfV = 1;

/// The area of the CPU's identification, from byte 0 on; it is not memory.
inline constexpr std::uint8_t kSystemInformation = 0x03;
inline constexpr std::size_t kIdentificationName = 16, kIdentificationRelease = 4,
                             kIdentificationBytes = kIdentificationName + kIdentificationRelease;

/// The service that RUN and STOP name at the end of their parameters, after its length.
inline constexpr std::string_view kProgram = "P_PROGRAM";

// Groups of user data, and the services of each.
inline constexpr std::uint8_t kBlockGroup = 3, kListBlocks = 1, kListBlocksOfType = 2, kBlockInfo = 3;
inline constexpr std::uint8_t kClockGroup = 7, kReadClock = 1, kSetClock = 2;
inline constexpr std::uint8_t kForceGroup = 8, kForce = 0x0B, kSetInStop = 0x0E;

/// The parameters of user data: 00 01 12 length(1) request or answer(1) group service number, and then, of an answer and of
/// a request to force, 00 00 error(2).
struct UserData {
  std::uint8_t group = 0, service = 0, number = 0;
  bool is_answer = false;
  std::uint16_t error = 0;  ///< of an answer
};
Bytes parameters_of(const UserData& user_data);
/// Reads the parameters of user data; nothing if they are too few.
std::optional<UserData> user_data_in(std::span<const std::uint8_t> parameters);

/// A list in the data of user data: FF 09 length(2), then its bytes.
Bytes data_of_list(std::span<const std::uint8_t> list);
/// Reads a list; nothing if its length is not that of the bytes after it.
std::optional<std::span<const std::uint8_t>> list_in(std::span<const std::uint8_t> data);

/// The clock in data: FF 09 00 0A 00, the century, and then the eight bytes of TODR, whose last two are milliseconds and day
/// of the week. All are BCD.
struct WireClock {
  std::uint8_t century;
  std::array<std::uint8_t, 8> todr;
};
/// The data of a clock, from 1990 to 2089, as the clock has two figures for the year.
Bytes data_of_clock(const std::array<std::uint8_t, 8>& todr);
/// Reads a clock; nothing if there is none, as in the answer after the clock was set.
std::optional<WireClock> clock_in(std::span<const std::uint8_t> data);

/// A number of two bytes, as everything in a PDU counts.
inline void append16(Bytes& to, std::size_t value) {
  to.push_back(static_cast<std::uint8_t>(value >> 8));
  to.push_back(static_cast<std::uint8_t>(value));
}

/// The code of an area; 0 if it has none.
std::uint8_t code_of(Area area);

/// A variable in the parameters of a read or write. T, C and HC have the code of their area as their type.
struct Variable {
  std::uint8_t type;
  std::size_t count;
  Area area;
  std::uint32_t first;  ///< bit of the area, 24 bits; of T, C and HC their number
};
void append(Bytes& to, const Variable& variable);

/// A variable as it was received: not every type and area is known.
struct WireVariable {
  std::uint8_t type, area;
  std::uint16_t count, block;
  std::uint32_t address;  ///< like Variable::first
};
/// Reads a variable from kVariableBytes bytes.
WireVariable variable_at(std::span<const std::uint8_t> bytes);

/// The variables that a master forces, releases, or sets in STOP.
struct ForcedList {
  bool released = false;
  std::vector<WireVariable> variables{};
  std::vector<std::span<const std::uint8_t>> values{};  ///< of each variable; none if they are released
};
/// Reads the list in the data of user data. `head` is the number of bytes before each value. Nothing if there is less than
/// is listed. A list releases its values with 01, or by having none, as in a published description of the S7-200.
std::optional<ForcedList> forced_in(std::span<const std::uint8_t> data, std::size_t head);

/// Appends the identification as a variable, to read.
void append_identification(Bytes& to);

/// Anything but an answer, which has its error too.
Bytes pdu(Kind kind, std::uint16_t number, const Bytes& parameters, const Bytes& data);

}  // namespace s7200::s7
