// The PC1000 LAN: six-byte messages with a sync signal beside the data.
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tools/master/block_request.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kNoSync = "--no-sync";
constexpr std::uint8_t kUnit = 5;

class Pc1000Parser final : public BlockParser {
 public:
  explicit Pc1000Parser(const ProtocolUse& use) : BlockParser(use, !use.has(kNoSync)) {}

  std::vector<MasterAction> parse(const Words& words);

  void unit(const Words& operands);
  void station(const Words& operands);
  void erase(const Words&) { add(westinghouse::erase(), {.done = "memory erased"}); }

 private:
  void add(const Bytes& message, BlockRequest::About about) override;

  std::optional<std::uint8_t> addressed_, named_;  // units, by `unit` and by `station`
};

using LanVerb = Verb<Pc1000Parser>;

constexpr std::array kPc1000OwnVerbs{
    LanVerb{"unit", "[NUMBER]", "the PLC that all actions after it are for; shows its keyswitch and fault register", 0, 1,
            &Pc1000Parser::unit},
    LanVerb{"station", "NUMBER", "the unit that `unit` addresses if it names none", 1, 1, &Pc1000Parser::station},
    LanVerb{"erase", "", "ladder, output and holding registers; only in stop, and not on a PC1100", 0, 0,
            &Pc1000Parser::erase},
};
constexpr auto kPc1000Verbs =
    joined(kPc1000OwnVerbs, block_verbs<Pc1000Parser>("words of the PLC's memory, up to 128 at once: read 16#1234:2"));

std::vector<MasterAction> Pc1000Parser::parse(const Words& words) {
  return parse_with(*this, std::span<const LanVerb>(kPc1000Verbs), words, "unit 5 read 16#1234:2");
}

void Pc1000Parser::unit(const Words& operands) {
  if (!operands.empty()) station_ = static_cast<std::uint8_t>(parse_number(operands[0], 0, UINT8_MAX, "unit"));
  const std::string subject = operands.empty() ? fmt::format("unit {}", station_) : std::string();
  addressed_ = station_;
  named_.reset();
  add(westinghouse::set_unit_address(station_), {.subject = subject});
}

void Pc1000Parser::station(const Words& operands) {
  BlockParser::station(operands);
  named_ = station_;
}

/// Messages have no address: the unit that was addressed last takes them.
void Pc1000Parser::add(const Bytes& message, BlockRequest::About about) {
  if (named_ && named_ != addressed_)
    refuse(fmt::format("{}: station {} is not addressed{}; put 'unit {}' before it", text_, *named_,
                       addressed_ ? fmt::format(", unit {} is", *addressed_) : "", *named_));
  BlockParser::add(message, std::move(about));
}

}  // namespace

const Protocol& pc1000_lan_protocol() {
  static const Protocol protocol{
      .name = "pc1000-lan",
      .meaning = "Westinghouse PC1100, PC1200 and PC1250 on their local network",
      .station = kUnit,
      .format = {.parity = Parity::None},
      .over_modbus_tcp = false,
      .options =
          {{kNoSync, "", "the line has no sync signal; without this option it is DTR of a serial device", {}, nullptr},
           data_check_option()},
      .actions_help = "Actions of --protocol pc1000-lan; a PLC listens once it was addressed by its unit:\n" +
                      verbs_help(std::span<const LanVerb>(kPc1000Verbs)),
      .action_words = verb_words(std::span<const LanVerb>(kPc1000Verbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return Pc1000Parser(use).parse(words); },
      .is_complete = westinghouse::is_whole_answer,
      .patience = {.timeout = 500 * kMillisecond, .retries = 2},
      .choices = "--timeout, --retries [L10], --data-check [L4]",
      .plcs = westinghouse::find_plc("pc1000-lan")};
  return protocol;
}

}  // namespace s7200::tools
