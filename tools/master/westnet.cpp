// Westnet II: the commands of the data highway, and blocks of the PLC that is addressed.
#include "serial_sim/westinghouse/messages/block_message.hpp"
#include "tools/master/block_request.hpp"
#include "tools/master/written_values.hpp"

namespace s7200::tools {
namespace {

using westinghouse::HighwayCommand;

class WestnetParser final : public BlockParser {
 public:
  explicit WestnetParser(const ProtocolUse& use) : BlockParser(use, false) {}

  std::vector<MasterAction> parse(const Words& words);

  void address(const Words& operands);
  void remote(const Words&) { add(westinghouse::highway(HighwayCommand::ReadRemoteAddress), {}); }
  void local(const Words&) { add(westinghouse::highway(HighwayCommand::ReadLocalAddress), {}); }
  void status(const Words&) { add(westinghouse::highway(HighwayCommand::ReadHighwayStatus), {}); }
  void open(const Words&) { add(westinghouse::highway(HighwayCommand::OpenSession), {}); }
  void close(const Words&) { add(westinghouse::highway(HighwayCommand::CloseSession), {}); }
  void session(const Words&) { add(westinghouse::highway(HighwayCommand::ReadSessionStatus), {}); }
};

using WestnetVerb = Verb<WestnetParser>;

constexpr std::array kWestnetOwnVerbs{
    WestnetVerb{"address", "DROP[.SUBDROP]",
                "the PLC for all actions after it: address 17, or 16#11; --plc and answers have it in hex: 00.11.00", 1, 1,
                &WestnetParser::address},
    WestnetVerb{"open", "", "a session with it", 0, 0, &WestnetParser::open},
    WestnetVerb{"close", "", "the session", 0, 0, &WestnetParser::close},
    WestnetVerb{"session", "", "who is in session with it", 0, 0, &WestnetParser::session},
    WestnetVerb{"status", "", "of the highway: the last error", 0, 0, &WestnetParser::status},
    WestnetVerb{"remote", "", "drop that is addressed", 0, 0, &WestnetParser::remote},
    WestnetVerb{"local", "", "drop of this computer", 0, 0, &WestnetParser::local},
};
constexpr auto kWestnetVerbs =
    joined(kWestnetOwnVerbs, block_verbs<WestnetParser>("words of the PLC's memory, up to 32 at once: read 16#1234:2"));

std::vector<MasterAction> WestnetParser::parse(const Words& words) {
  return parse_with(*this, std::span<const WestnetVerb>(kWestnetVerbs), words, "address 17 read 16#1234:2");
}

void WestnetParser::address(const Words& operands) {
  constexpr std::int64_t kLastDrop = 254;
  const auto parts = split_at(operands[0], '.');
  const auto drop = static_cast<std::uint8_t>(parse_number(parts ? parts->first : operands[0], 1, kLastDrop, "drop"));
  const auto subdrop = static_cast<std::uint8_t>(parts ? parse_number(parts->second, 0, 1, "subdrop") : 0);
  add(westinghouse::highway(HighwayCommand::SetAddress, 0, drop, subdrop),
      {.subject = fmt::format("drop {}, subdrop {}", drop, subdrop)});
}

}  // namespace

const Protocol& westnet_protocol() {
  static const Protocol protocol{
      .name = "westnet",
      .meaning = "Westinghouse PLCs over the data highway Westnet II",
      .station = {},
      .format = {.parity = Parity::None},
      .over_modbus_tcp = false,
      .options = {data_check_option()},
      .actions_help = "Actions of --protocol westnet; the PLC is addressed first:\n" +
                      verbs_help(std::span<const WestnetVerb>(kWestnetVerbs)),
      .action_words = verb_words(std::span<const WestnetVerb>(kWestnetVerbs)),
      .actions = [](const Words& words, const ProtocolUse& use) { return WestnetParser(use).parse(words); },
      .is_complete = westinghouse::is_whole_answer,
      .choices = "--data-check [L4]",
      .plcs = westinghouse::find_plc("westnet")};
  return protocol;
}

}  // namespace s7200::tools
