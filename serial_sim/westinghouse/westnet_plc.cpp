#include "serial_sim/westinghouse/westnet_plc.hpp"

#include <utility>

#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::uint8_t kNoError = 0, kInvalidDrop = 2, kInvalidSize = 4;
constexpr std::uint8_t kMostBytes = 64;  // in a block
constexpr std::uint8_t kLastDrop = 254, kLastSubdrop = 1;

Bytes answer_with(HighwayCommand command, std::uint32_t drop) {
  return highway(command, static_cast<std::uint8_t>(drop >> 16), static_cast<std::uint8_t>(drop >> 8 & 0xFF),
                 static_cast<std::uint8_t>(drop & 0xFF));
}

}  // namespace

/// The gap between two characters was too long.
void WestnetPlc::wake(Time) {
  reader_.begin_anew();
  wake_at(kNever);
}

/// After power-up no drop is addressed and no session is open.
void WestnetPlc::restart(Time) {
  reader_.begin_anew();
  settings_.remote = settings_.session = kNowhere;
  status_ = kNoError;
}

void WestnetPlc::hear(const ReceivedCharacter& character) {
  const Time length = settings_.line.character_time(), end = character.start + length;
  const Time reply_at = end + settings_.answer_after * length;
  wake_at(end + settings_.gap_ms * kMillisecond);
  switch (reader_.take(character)) {
    case MessageReader::State::Wrong:
      return answer_or_be_silent(error(settings_.malformed), reply_at);
    case MessageReader::State::Whole: {
      Bytes reply = this->reply(reader_.message());
      wake(end);
      return answer_or_be_silent(std::move(reply), reply_at);
    }
    default:
      return;
  }
}

Bytes WestnetPlc::error(std::uint8_t code) {
  if (code == kNoError) return {};
  status_ = code;
  return {settings_.error_byte, code};
}

std::uint8_t WestnetPlc::fault_of_plc() const {
  const bool there = settings_.remote != kNowhere && settings_.remote == settings_.plc_at;
  return there ? kNoError : kInvalidDrop;
}

std::uint8_t WestnetPlc::fault_of_session() const {
  const bool others = settings_.session != kNowhere && settings_.session != settings_.local;
  return others ? busy() : kNoError;
}

Bytes WestnetPlc::reply(Data message) {
  const auto opcode = static_cast<Opcode>(message[0]);
  if (opcode == Opcode::Highway) return highway(message);
  const bool block = opcode == Opcode::ReadBlock || opcode == Opcode::WriteBlock;
  if (!block && opcode != Opcode::BitWrite) return error(settings_.malformed);
  if (const std::uint8_t code = fault_of_plc()) return error(code);
  if (block && message[3] >= kMostBytes) return error(kInvalidSize);
  if (const std::uint8_t code = fault_of_session()) return error(code);
  Bytes reply = pc_.carry_out(message);
  if (reply.empty()) return error(pc_.settings.error != kNoError ? pc_.settings.error : settings_.malformed);
  status_ = kNoError;
  return reply;
}

Bytes WestnetPlc::highway(Data message) {
  const auto command = static_cast<HighwayCommand>(message[1]);
  if (command == HighwayCommand::SetAddress) return set_address(message);
  if (message[2] != 0 || message[3] != 0 || message[4] != 0) return error(settings_.malformed);
  const auto done = [&](std::uint32_t drop) {
    status_ = kNoError;
    return answer_with(command, drop);
  };
  switch (command) {
    case HighwayCommand::ReadRemoteAddress:
      return done(settings_.remote == kNowhere ? 0 : settings_.remote);
    case HighwayCommand::ReadLocalAddress:
      return done(settings_.local);
    case HighwayCommand::ReadHighwayStatus: {
      const std::uint32_t status = status_;
      if (settings_.status == WestnetSettings::Status::Once) status_ = kNoError;
      return answer_with(command, status << 16);
    }
    case HighwayCommand::OpenSession:
    case HighwayCommand::CloseSession:
      if (const std::uint8_t code = fault_of_plc()) return error(code);
      if (const std::uint8_t code = fault_of_session()) return error(code);
      settings_.session = command == HighwayCommand::OpenSession ? settings_.local : kNowhere;
      return done(0);
    case HighwayCommand::ReadSessionStatus: {
      if (const std::uint8_t code = fault_of_plc()) return error(code);
      if (settings_.session != kNowhere) return done(settings_.session);
      const bool zeros = settings_.free_status == WestnetSettings::FreeStatus::Zeros;
      return done(std::uint32_t{kNoSession} << 16 | (zeros ? 0 : settings_.remote & 0xFFFF));
    }
    case HighwayCommand::SetAddress:
      break;
  }
  return error(settings_.malformed);
}

Bytes WestnetPlc::set_address(Data message) {
  const std::uint32_t drop = static_cast<std::uint32_t>(message[2] << 16 | message[3] << 8 | message[4]);
  const bool valid = message[2] == 0 && message[3] >= 1 && message[3] <= kLastDrop && message[4] <= kLastSubdrop;
  const bool missing = drop != settings_.plc_at && settings_.missing_plc == WestnetSettings::MissingPlc::Refused;
  if (!valid || missing) return error(kInvalidDrop);
  const bool leaves = drop != settings_.remote && settings_.session == settings_.local;
  if (leaves && settings_.new_address == WestnetSettings::NewAddress::ClosesSession) settings_.session = kNowhere;
  settings_.remote = drop;
  status_ = kNoError;
  return answer_with(HighwayCommand::SetAddress, drop);
}

const std::vector<Setting<WestnetPlc>>& WestnetPlc::settings() {
  using enum SettingForm::Notation;
  using S = WestnetSettings;
  static const std::vector<Setting<WestnetPlc>> kSettings = [] {
    std::vector<Setting<WestnetPlc>> rows;
    const auto own = [](auto& plc) -> auto& { return plc.settings_; };
    const auto add = [&](SettingForm form, auto member) {
      rows.push_back(setting_of<WestnetPlc>(std::move(form), own, member));
    };
    add({"local", "", "drop of the computer", Drop}, &S::local);
    add({"plc_at", "", "drop of the PLC", DropOrNone}, &S::plc_at);
    add({"remote", "", "drop that is addressed", DropOrNone}, &S::remote);
    add({"session", "", "drop that is in session with the PLC", DropOrNone}, &S::session);
    add_pc1000_settings(
        rows, [](auto& plc) -> auto& { return plc.pc_; });
    add_line_settings(
        rows, "W1", [](auto& plc) -> auto& { return plc.settings_.line; });
    add({"gap_ms", "W1", "milliseconds between two characters of a message, at most", Decimal, {}, 1, 10'000}, &S::gap_ms);
    add({"answer_after", "W1", "characters of silence before an answer", Decimal, {}, 1, 200}, &S::answer_after);
    add({"free_status", "W2", "drop in the session status of a free PLC", Word,
         words_of<S::FreeStatus>({{S::FreeStatus::Zeros, "zeros"}, {S::FreeStatus::Addressed, "addressed"}})},
        &S::free_status);
    add({"busy_code", "W3", "how the 12 of error 12 is meant", Word,
         words_of<S::BusyCode>({{S::BusyCode::Hex, "hex"}, {S::BusyCode::Decimal, "decimal"}})},
        &S::busy_code);
    add({"new_address", "W4", "what addressing another drop does to a session", Word,
         words_of<S::NewAddress>(
             {{S::NewAddress::KeepsSession, "keeps_session"}, {S::NewAddress::ClosesSession, "closes_session"}})},
        &S::new_address);
    add({"error_byte", "W5", "first byte of an error"}, &S::error_byte);
    add({"status", "W5", "how long the highway status shows an error", Word,
         words_of<S::Status>({{S::Status::UntilSuccess, "until_success"}, {S::Status::Once, "once"}})},
        &S::status);
    add({"missing_plc", "W6", "addressing a drop without PLC", Word,
         words_of<S::MissingPlc>({{S::MissingPlc::Acknowledged, "acknowledged"}, {S::MissingPlc::Refused, "refused"}})},
        &S::missing_plc);
    add({"malformed", "W7", "answered as an error to what is not understood; 00 for silence"}, &S::malformed);
    return rows;
  }();
  return kSettings;
}

const std::vector<Cells<WestnetPlc>>& WestnetPlc::cells() {
  static const std::vector<Cells<WestnetPlc>> kCells{pc1000_words<WestnetPlc>([](auto& plc) -> auto& { return plc.pc_; })};
  return kCells;
}

}  // namespace s7200::westinghouse
