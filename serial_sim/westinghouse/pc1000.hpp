// A PLC of the PC1000 family behind its port: memory, keyswitch, fault register, and the commands on them.
//
// [L4] … [L9] name the choices of ../shared/reference/westinghouse_protocols.md.
#pragma once

#include <optional>
#include <span>

#include "serial_sim/westinghouse/memory.hpp"
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "serial_sim/westinghouse/messages/words.hpp"
#include "serial_sim/westinghouse/plc.hpp"

namespace s7200::westinghouse {

struct Pc1000Settings {
  enum class Model : std::uint8_t { Pc1200, Pc1250, Pc1100 };
  enum class Key : std::uint8_t { Stop, Protect, Modify };
  enum class Addresses : std::uint8_t { Words, Bytes };
  enum class RetestIn : std::uint8_t { Stop, Always };
  enum class WriteIn : std::uint8_t { Always, Unprotected };
  enum class Erases : std::uint8_t { Memory, Registers };

  Model plc = Model::Pc1200;
  Key key = Key::Stop;
  std::uint16_t fault = 0;          ///< the fault register
  std::uint16_t lasting_fault = 0;  ///< that comes back after a retest

  DataCheck data_check = DataCheck::Sum;   ///< [L4]
  std::uint8_t key_upper_bits = 0;         ///< [L5]
  std::uint8_t set_nibble = 1;             ///< [L6] of a bit write that sets; 0 resets
  Addresses addresses = Addresses::Words;  ///< [L7] of blocks; those of bits are words, as that of the retest is said to be
  std::uint8_t error = 0;                  ///< [L8] code of what is answered to what is wrong or refused; 0: silence
  RetestIn retest = RetestIn::Stop;        ///< [L9]
  WriteIn write = WriteIn::Always;         ///< [L9]
  Erases erases = Erases::Memory;          ///< [L9]

  bool operator==(const Pc1000Settings&) const = default;
};

class Pc1000 {
 public:
  /// The length in bytes of a message that begins with these six bytes or more; 0 if no opcode has this number.
  static std::size_t length(std::span<const std::uint8_t> begin);

  /// Carries out a whole message and returns the answer; empty if it is wrong or refused. Set unit address and the highway's
  /// commands are not for the PLC.
  Bytes carry_out(std::span<const std::uint8_t> message);

  /// Whether the check of a message's first six bytes is right.
  static bool check_right(std::span<const std::uint8_t> message);

  std::uint8_t key_byte() const;

  Pc1000Settings settings{};
  WordMemory words{};

  bool operator==(const Pc1000&) const = default;

 private:
  using Data = std::span<const std::uint8_t>;

  Bytes read(Data message) const;
  Bytes write(Data message);
  Bytes write_bit(Data message);
  Bytes erase(Data message);
  /// The first byte of a block among all of memory; nothing if the block runs past the end.
  std::optional<std::uint32_t> first_byte(Data message) const;
  std::uint8_t byte(std::uint32_t address) const;
  void set_byte(std::uint32_t address, std::uint8_t value);
};

/// Joins characters to messages.
class MessageReader {
 public:
  enum class State : std::uint8_t {
    Part,
    Whole,  ///< its first six bytes have a right check
    Wrong,  ///< no such opcode, or a wrong check; what follows is not taken for a message
    Deaf,   ///< after that, and after a damaged character, until begin_anew()
  };

  State take(const ReceivedCharacter& character);
  void begin_anew() { *this = {}; }
  const Bytes& message() const { return message_; }

  bool operator==(const MessageReader&) const = default;

 private:
  Bytes message_;
  bool deaf_ = false;
};

/// The rows of its settings and its memory, for a PLC `Self` that reaches it by `pc`.
template <class Self, class Pc>
void add_pc1000_settings(std::vector<Setting<Self>>& rows, Pc pc) {
  using enum SettingForm::Notation;
  using S = Pc1000Settings;
  const auto settings = [pc](auto& plc) -> auto& { return pc(plc).settings; };
  const auto add = [&](SettingForm form, auto member) {
    rows.push_back(setting_of<Self>(std::move(form), settings, member));
  };
  add({"plc", "", "model; a PC1100 does not erase", Word,
       words_of<S::Model>({{S::Model::Pc1200, "pc1200"}, {S::Model::Pc1250, "pc1250"}, {S::Model::Pc1100, "pc1100"}})},
      &S::plc);
  add({"key", "", "keyswitch", Word,
       words_of<S::Key>({{S::Key::Stop, "stop"}, {S::Key::Protect, "protect"}, {S::Key::Modify, "modify"}})},
      &S::key);
  add({"fault", "", "the fault register", Hex, {}, 0, UINT16_MAX}, &S::fault);
  add({"lasting_fault", "", "what comes back into it after a retest", Hex, {}, 0, UINT16_MAX}, &S::lasting_fault);
  add({"data_check", "L4", "check of a block of data", Word, kDataCheckWords}, &S::data_check);
  add({"key_upper_bits", "L5", "bits 4 to 7 of the keyswitch byte", Hex, {}, 0, 15}, &S::key_upper_bits);
  add({"set_nibble", "L6", "high nibble of a bit write that sets the bit; 0 resets it", Hex, {}, 1, 15}, &S::set_nibble);
  add({"addresses", "L7", "what addresses of blocks count; those of bits are words", Word,
       words_of<S::Addresses>({{S::Addresses::Words, "words"}, {S::Addresses::Bytes, "bytes"}})},
      &S::addresses);
  add({"error", "L8", "code of the error that answers what is wrong or refused; 00 for silence"}, &S::error);
  add({"retest", "L9", "keyswitch that lets a retest clear the fault register", Word,
       words_of<S::RetestIn>({{S::RetestIn::Stop, "stop"}, {S::RetestIn::Always, "always"}})},
      &S::retest);
  add({"write", "L9", "keyswitch that lets blocks and bits be written", Word,
       words_of<S::WriteIn>({{S::WriteIn::Always, "always"}, {S::WriteIn::Unprotected, "unprotected"}})},
      &S::write);
  add({"erases", "L9", "what is erased: all memory, or the holding registers 1 to 2048", Word,
       words_of<S::Erases>({{S::Erases::Memory, "memory"}, {S::Erases::Registers, "registers"}})},
      &S::erases);
}

template <class Self, class Pc>
Cells<Self> pc1000_words(Pc pc) {
  return {
      "W",
      true,
      0,
      UINT16_MAX,
      UINT16_MAX,
      "words of the memory",
      [=](const Self& plc, std::uint32_t a) { return std::uint32_t{pc(plc).words.read(a)}; },
      [=](Self& plc, std::uint32_t a, std::uint32_t value) { pc(plc).words.write(a, static_cast<std::uint16_t>(value)); }};
}

}  // namespace s7200::westinghouse
