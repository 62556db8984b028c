#include "serial_sim/westinghouse/lan_plc.hpp"

#include <utility>

#include "serial_sim/westinghouse/messages/words.hpp"

namespace s7200::westinghouse {

void LanPlc::begin_anew() {
  reader_.begin_anew();
  wake_at(kNever);
}

/// The rising edge empties the receive buffer; a falling one throws away what is not complete.
void LanPlc::sync(bool high, Time at) {
  if (settings_.sync == LanSettings::Sync::Ignored) return;
  if (high && !sync_high_) sync_since_ = at;
  sync_high_ = high;
  begin_anew();
}

/// The sync signal is what it is, and counts from now on.
void LanPlc::restart(Time at) {
  begin_anew();
  on_line_ = false;
  sync_since_ = at;
}

/// The gap between two characters was too long.
void LanPlc::wake(Time) { begin_anew(); }

void LanPlc::hear(const ReceivedCharacter& character) {
  const bool counts = settings_.sync == LanSettings::Sync::Ignored || (sync_high_ && character.start >= sync_since_);
  if (!counts) return;
  const Time length = settings_.line.character_time(), end = character.start + length;
  const Time reply_at = end + settings_.answer_after * length;
  wake_at(end + settings_.gap_ms * kMillisecond);
  switch (reader_.take(character)) {
    case MessageReader::State::Wrong:
      return answer_or_be_silent(on_line_ ? refusal() : Bytes{}, reply_at);
    case MessageReader::State::Whole: {
      Bytes reply = this->reply(reader_.message());
      begin_anew();
      return answer_or_be_silent(std::move(reply), reply_at);
    }
    default:
      return;
  }
}

Bytes LanPlc::reply(std::span<const std::uint8_t> message) {
  if (static_cast<Opcode>(message[0]) == Opcode::SetUnitAddress) return set_unit_address(message);
  if (!on_line_) return {};
  Bytes reply = pc_.carry_out(message);
  return reply.empty() ? refusal() : reply;
}

Bytes LanPlc::refusal() const {
  const std::uint8_t code = pc_.settings.error;
  return code == 0 ? Bytes{} : Bytes{kHighwayError, code};
}

Bytes LanPlc::set_unit_address(std::span<const std::uint8_t> message) {
  if (message[2] != 0 || message[3] != 0 || message[4] != 0) return {};
  on_line_ = message[1] == settings_.unit;
  if (!on_line_) return {};
  const std::uint16_t fault = pc_.settings.fault;
  return westinghouse::message(Opcode::SetUnitAddress, settings_.unit, pc_.key_byte(),
                               static_cast<std::uint8_t>(fault & 0xFF), static_cast<std::uint8_t>(fault >> 8));
}

const std::vector<Setting<LanPlc>>& LanPlc::settings() {
  using enum SettingForm::Notation;
  using S = LanSettings;
  static const std::vector<Setting<LanPlc>> kSettings = [] {
    std::vector<Setting<LanPlc>> rows;
    const auto own = [](auto& plc) -> auto& { return plc.settings_; };
    const auto add = [&](SettingForm form, auto member) {
      rows.push_back(setting_of<LanPlc>(std::move(form), own, member));
    };
    add({"unit", "", "its address, in hex"}, &S::unit);
    add_pc1000_settings(
        rows, [](auto& plc) -> auto& { return plc.pc_; });
    add_line_settings(
        rows, "L1", [](auto& plc) -> auto& { return plc.settings_.line; });
    add({"sync", "L2", "whether characters count only while the sync signal is high", Word,
         words_of<S::Sync>({{S::Sync::Required, "required"}, {S::Sync::Ignored, "ignored"}})},
        &S::sync);
    add({"gap_ms", "L3", "milliseconds between two characters of a message, at most", Decimal, {}, 1, 10'000}, &S::gap_ms);
    add({"answer_after", "L3", "characters of silence before an answer", Decimal, {}, 1, 200}, &S::answer_after);
    return rows;
  }();
  return kSettings;
}

const std::vector<Cells<LanPlc>>& LanPlc::cells() {
  static const std::vector<Cells<LanPlc>> kCells{pc1000_words<LanPlc>([](auto& plc) -> auto& { return plc.pc_; })};
  return kCells;
}

}  // namespace s7200::westinghouse
