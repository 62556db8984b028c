#include "tools/command/polling/master_menu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <utility>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/address.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/line_editor.hpp"
#include "tools/command/terminal/screen.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/master/session.hpp"

namespace s7200::tools {
namespace {

using Words = std::vector<std::string>;
using Answers = std::array<std::string, 3>;

/// A question, and the answer that an empty line stands for; nothing: there must be one, such as `example`.
struct Question {
  std::string_view text, usual{}, example = usual;
};

/// A Modbus function: its action, with the answers in it.
struct Function {
  std::string_view key, name, action;
  std::array<Question, 3> questions{};
  std::string_view option{};  ///< of the protocol
  bool takes_more = false;    ///< what is typed besides ends the action; not asked for
};

constexpr Question kHowMany{"how many", "1"};

constexpr Function kFunctions[] = {
    {"1", "read coils", "read coils {0}:{1}", {{{"first coil", "0"}, kHowMany}}},
    {"2", "read inputs", "read inputs {0}:{1}", {{{"first input", "0"}, kHowMany}}},
    {"3", "read holding registers", "read holding {0}:{1}", {{{"first register", "0"}, kHowMany}}},
    {"4", "read input registers", "read input-registers {0}:{1}", {{{"first register", "0"}, kHowMany}}},
    {"5", "force a coil", "write coils {0}={1}", {{{"coil", "0"}, {"on or off", "", "on"}}}},
    {"6", "preset a register", "write holding {0}={1}", {{{"register", "0"}, {"value", "", "0"}}}},
    {"7", "read exception status", "exception-status"},
    {"8", "loopback", "loopback", {}, "", true},
    {"F", "force coils", "write coils {0}={1}", {{{"first coil", "0"}, {"on or off, each", "", "on"}}}, "--always-15"},
    {"P", "preset registers", "write holding {0}={1}", {{{"first register", "0"}, {"values", "", "0"}}}, "--always-16"},
    {"R", "report slave ID", "slave-id"},
    {"Z", "general read", "general-read {0}:{1}:{2}", {{{"segment", "0"}, {"offset", "0"}, {"how many bytes", "1"}}}},
    {"A", "general write", "general-write {0}:{1}={2}", {{{"segment", "0"}, {"offset", "0"}, {"bytes", "", "0"}}}},
};

/// What the protocol makes an action of: in words, so that it goes to the slave that is set when it is done again.
struct MenuRequest {
  Words words{};
  std::string_view option{};  ///< of the protocol
};

constexpr std::string_view kHelp =
    "A key and Enter begin what is asked for; answers may follow the key at once: 3 0 10. An empty answer is the one in\n"
    "brackets. Data may follow 8 and L; without them each loopback sends another word.\n"
    "Numbers are decimal, or 16#04D2; addresses count from 0, or are written as 40011. Several values have blanks or\n"
    "commas between them. Actions of s7200 master do as well: read 40011:2, write 00003=on, function 22 ….\n"
    "L and T go on until Ctrl-C, and show failures and statistics.\n";

constexpr int kFailuresInMenu = 20;
constexpr int kKeyWidth = 39;                     // columns
constexpr int kRowsOfView = 4, kRowsOfKeys = 12;  // with the latencies
constexpr int kRowsForKeys = 24;                  // of a terminal that has room for the keys

bool has_room_for_keys(int columns, int rows) { return rows >= kRowsForKeys && columns >= 2 * kKeyWidth; }

std::string joined_by_commas(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() || text.ends_with(',') ? "" : ",") + word;
  return text;
}

/// Of an address: 40011 does, 10 does not. It must be the area that the key is for.
bool names_its_area(const std::string& address, const std::string& area) {
  constexpr std::size_t kNotation = 5;  // digits
  if (address.size() < kNotation || !std::ranges::all_of(address, stl::is_digit)) return false;
  const auto named = modbus::parse_address(address);
  if (!named) throw std::invalid_argument(named.why());
  const modbus::AreaRow& row = modbus::row_of(named->area);
  if (row.word != area)
    throw std::invalid_argument(fmt::format("{} is a {}, and this key is for {}", address, row.singular, area));
  return true;
}

std::size_t questions_of(const Function& function) {
  return static_cast<std::size_t>(
      std::ranges::count_if(function.questions, [](const Question& one) { return !one.text.empty(); }));
}

ProtocolUse in_menu(ProtocolUse use) {
  use.options_are_open = false;
  return use;
}

class Menu {
 public:
  Menu(const MasterOptions& options, const MenuTarget& target)
      : options_(options),
        target_(target),
        use_(in_menu(options.use(target.over_modbus_tcp))),
        session_(options.session(!target.over_modbus_tcp)),
        slave_(target.open(session_.master)) {}

  int run();

 private:
  /// What is wrong with what was typed.
  using Wrong = std::invalid_argument;

  /// What the menu does itself.
  struct Key {
    std::string_view key, name;
    void (Menu::*press)(Words& answers);
    bool takes_answers = false;
  };
  static const std::array<Key, 8> kOthers;

  void show_keys() const;
  bool keys_are_in_view() const { return screen_.on() && screen_.view_rows() >= kRowsOfView; }
  std::vector<std::string> key_lines(int columns) const;
  std::vector<std::string> view() const;
  void draw();
  void look_again();
  std::optional<std::string> read();
  std::string take_answer(const Question& question, Words& answers, bool last);
  std::string ask(const Question& question, Words& answers, bool last, const std::function<void(const std::string&)>& check);
  void execute(Words words);
  bool execute_key(const std::string& key, Words& answers);
  Words words_for(const Function& function, const Answers& given) const;
  void do_function(const Function& function, Words& answers);
  void do_request(MenuRequest request);
  void repeat_loopbacks(Words& answers);
  void repeat(Words& answers);
  void count_anew(Words&) { statistics_ = {}; }
  void show_menu(Words&) { keys_are_in_view() ? fmt::print("the keys are above\n") : show_keys(); }
  void help(Words&) { fmt::print("{}", kHelp); }
  void quit(Words&) { quit_ = true; }
  std::vector<MasterAction> actions_of(const MenuRequest& request) const;
  void perform(const std::vector<MasterAction>& actions, std::uint64_t rounds);
  void show(const MasterResult& result) const;
  void change_slave(Words& answers);
  void configure_port(Words& answers);
  void open();

  const MasterOptions& options_;
  const MenuTarget& target_;
  ProtocolUse use_;
  SessionSettings session_;
  std::unique_ptr<Slave> slave_;
  ExchangeStatistics statistics_;
  MenuRequest last_;  ///< done last
  bool quit_ = false;
  LineEditor editor_{">> ", "master_menu_history", [](std::string_view) { return Completions{}; }};
  Screen screen_{{.name = "menu", .fewest_columns = 40, .fewest_rows = 10, .view = [](int columns, int rows) {
                    return has_room_for_keys(columns, rows) ? kRowsOfView + kRowsOfKeys : kRowsOfView;
                  }}};
};

constexpr std::array<Menu::Key, 8> Menu::kOthers{{
    {"L", "loopbacks without end", &Menu::repeat_loopbacks, true},
    {"T", "test: the last one without end", &Menu::repeat},
    {"S", "slave", &Menu::change_slave, true},
    {"C", "configure the port", &Menu::configure_port, true},
    {"N", "new statistics", &Menu::count_anew},
    {"M", "menu", &Menu::show_menu},
    {"H", "help", &Menu::help},
    {"Q", "quit", &Menu::quit},
}};

// --- what is seen ---

std::vector<std::string> Menu::key_lines(int columns) const {
  std::vector<std::string> keys;
  for (const Function& function : kFunctions) keys.push_back(fmt::format("{}  {}", function.key, function.name));
  for (const Key& other : kOthers) keys.push_back(fmt::format("{}  {}", other.key, other.name));
  keys.emplace_back("Enter follows each key");
  if (columns < 2 * kKeyWidth) return keys;
  const std::size_t rows = (keys.size() + 1) / 2;
  for (std::size_t i = 0; i + rows < keys.size(); ++i) keys[i] = fmt::format("{:<{}}{}", keys[i], kKeyWidth, keys[i + rows]);
  keys.resize(rows);
  return keys;
}

void Menu::show_keys() const {
  for (const std::string& line : key_lines(screen_.columns())) fmt::print("{}\n", line);
}

std::vector<std::string> Menu::view() const {
  const auto format = target_.format(session_.master);
  std::vector<std::string> rows{
      fmt::format("Modbus master  slave {}  {}", use_.station, stl::printable(slave_ ? slave_->name() : options_.target)),
      format ? format_text(*format) : "over TCP"};
  const std::string statistics = statistics_.text(options_.protocol->refusal);
  const std::size_t end = statistics.find('\n');
  rows.push_back(statistics.substr(0, end));
  if (screen_.view_rows() == rows.size()) return rows;
  rows.push_back(statistics.substr(end + 1, statistics.find('\n', end + 1) - end - 1));
  for (std::string& line : key_lines(screen_.columns())) rows.push_back(std::move(line));
  return rows;
}

void Menu::draw() {
  if (screen_.on()) screen_.draw(view());
}

/// The terminal has another size, or the process goes on.
void Menu::look_again() {
  const auto shown = screen_.on() ? screen_.fit() : screen_.switch_on();
  if (!shown.why().empty()) fmt::print("{}\n", shown.why());
  draw();
}

void Menu::show(const MasterResult& result) const {
  fmt::print("{}\n", heading(result));
  for (const std::string& line : lines(result)) fmt::print("{}\n", line);
  fmt::print("{}", frames_text(result));
}

// --- what is typed ---

/// The rest of the answers is the last one.
std::string Menu::take_answer(const Question& question, Words& answers, bool last) {
  if (answers.empty()) {
    const std::string usual = question.usual.empty() ? "" : fmt::format(" [{}]", question.usual);
    const auto typed = editor_.ask(fmt::format("{}{}: ", question.text, usual));
    if (!typed) throw Wrong("given up");
    answers = stl::split_words(*typed);
    if (answers.empty() && question.usual.empty()) throw Wrong(fmt::format("{}: an answer is needed", question.text));
    if (answers.empty()) answers = {std::string(question.usual)};
  }
  if (last) return joined_by_commas(std::exchange(answers, {}));
  std::string answer = answers.front();
  answers.erase(answers.begin());
  return answer;
}

/// What `check` refuses is asked for again, unless it was given with the key.
std::string Menu::ask(const Question& question, Words& answers, bool last,
                      const std::function<void(const std::string&)>& check) {
  while (true) {
    const bool given = !answers.empty();
    std::string answer = take_answer(question, answers, last);
    try {
      check(answer);
      return answer;
    } catch (const Wrong& wrong) {
      if (given) throw;
      fmt::print("{}\n", stl::printable(wrong.what()));
      answers.clear();
    }
  }
}

Words Menu::words_for(const Function& function, const Answers& given) const {
  Words words = stl::split_words(fmt::format(fmt::runtime(function.action), given[0], given[1], given[2]));
  if (words.size() == 3 && names_its_area(given[0], words[1])) words.erase(words.begin() + 1);
  return words;
}

/// A wrong answer is refused before the next question, which has its example as answer until then.
void Menu::do_function(const Function& function, Words& answers) {
  Answers given;
  const std::size_t count = questions_of(function);
  for (std::size_t i = 0; i < count; ++i) given[i] = function.questions[i].example;
  for (std::size_t i = 0; i < count; ++i) {
    ask(function.questions[i], answers, i + 1 == count, [&](const std::string& answer) {
      if (const std::size_t more = answer.find_first_of(":="); more != std::string::npos)
        throw Wrong(fmt::format("'{}': write {} alone; what follows '{}' is asked for by itself", stl::shortened(answer),
                                answer.substr(0, more), answer[more]));
      given[i] = answer;
      actions_of({words_for(function, given), function.option});
    });
  }
  Words words = words_for(function, given);
  if (!answers.empty() && !function.takes_more) throw Wrong(fmt::format("{} asks for nothing", function.name));
  if (!answers.empty()) words.push_back(joined_by_commas(std::exchange(answers, {})));
  do_request({std::move(words), function.option});
}

std::vector<MasterAction> Menu::actions_of(const MenuRequest& request) const {
  ProtocolUse use = use_;
  if (!request.option.empty()) use.given[std::string(request.option)];
  return options_.protocol->actions(request.words, use);
}

void Menu::do_request(MenuRequest request) {
  const std::vector<MasterAction> actions = actions_of(request);
  last_ = std::move(request);
  perform(actions, 1);
}

void Menu::repeat_loopbacks(Words& answers) {
  MenuRequest loopbacks{.words = {"loopback"}};
  if (!answers.empty()) loopbacks.words.push_back(joined_by_commas(std::exchange(answers, {})));
  actions_of(loopbacks);  // which says what is wrong with the data
  last_ = std::move(loopbacks);
  repeat(answers);
}

void Menu::repeat(Words&) {
  if (last_.words.empty()) throw Wrong("there is nothing to repeat yet");
  const std::vector<MasterAction> actions = actions_of(last_);
  fmt::print("until Ctrl-C …\n");
  perform(actions, UINT64_MAX);
  fmt::print("{}", statistics_.text(options_.protocol->refusal));
}

void Menu::perform(const std::vector<MasterAction>& actions, std::uint64_t rounds) {
  if (!slave_) open();
  SessionSettings settings = session_;
  settings.rounds = rounds;
  MasterSession session(*slave_, actions, settings);
  int failures = 0;
  auto drawn = std::chrono::steady_clock::now();
  const auto take = [&](const MasterResult& result) {
    statistics_.add(result.answer.verdict, result.exchange.latency());
    for (int attempt = 1; attempt < result.attempts; ++attempt) statistics_.add_retry();
    if (rounds == 1) return show(result);
    if (result.answer.verdict == serial::Verdict::Right || failures > kFailuresInMenu) return;
    if (failures++ == kFailuresInMenu)
      fmt::print("further failures are only counted\n");
    else
      fmt::print("{}: {}\n", heading(result), short_text(result));
  };
  const auto refresh = [&] {
    constexpr auto kEvery = std::chrono::milliseconds(100);
    if (std::chrono::steady_clock::now() - drawn < kEvery) return;
    drawn = std::chrono::steady_clock::now();
    editor_.take_change() ? look_again() : draw();
  };
  session.run({take, refresh}, [] { return false; });
}

void Menu::open() { slave_ = target_.open(session_.master); }

void Menu::change_slave(Words& answers) {
  ProtocolUse use = use_;
  ask({"slave", std::to_string(use_.station)}, answers, true, [&](const std::string& text) {
    const auto station = parse_decimal<std::uint8_t>(text);
    if (!station) throw Wrong(fmt::format("'{}' is not a slave from 0 to 255", stl::shortened(text)));
    use.station = *station;
    options_.protocol->actions({"loopback", "0"}, {.station = *station == 0 ? std::uint8_t{1} : *station,
                                                   .over_modbus_tcp = use_.over_modbus_tcp,
                                                   .given = use_.given,
                                                   .options_are_open = false});  // which says what is wrong with it
  });
  use_ = std::move(use);
}

void Menu::configure_port(Words& answers) {
  const auto now = target_.format(session_.master);
  if (!now) throw Wrong("the port belongs to the other end of the connection");
  const auto number = [&](std::string_view what, std::uint32_t usual, std::uint32_t least, std::uint32_t most) {
    std::uint32_t chosen = usual;
    ask({what, std::to_string(usual)}, answers, false, [&](const std::string& text) {
      const auto value = parse_decimal<std::uint32_t>(text);
      if (!value || *value < least || *value > most)
        throw Wrong(fmt::format("{}: '{}' is not from {} to {}", what, stl::shortened(text), least, most));
      chosen = *value;
    });
    return chosen;
  };
  serial::MasterSettings master = session_.master;
  master.baud = number("baud", now->baud, 50, 1'000'000);
  master.data_bits = static_cast<std::uint8_t>(number("data bits", now->data_bits, 7, 8));
  ask({"parity: none, even, odd", word_of(now->parity)}, answers, false, [&](const std::string& parity) {
    const auto known = std::ranges::find(kParityWords, parity);
    if (known == kParityWords.end()) throw Wrong(fmt::format("'{}' is not none, even or odd", stl::shortened(parity)));
    master.parity = static_cast<Parity>(known - kParityWords.begin());
  });
  master.stop_bits = static_cast<std::uint8_t>(number("stop bits", now->stop_bits, 1, 2));
  slave_.reset();  // a device is open once only
  session_.master = master;
  open();
}

/// False for what is not a key.
bool Menu::execute_key(const std::string& key, Words& answers) {
  const auto function = std::ranges::find(kFunctions, key, &Function::key);
  if (function != std::end(kFunctions)) return do_function(*function, answers), true;
  const auto other = std::ranges::find(kOthers, key, &Key::key);
  if (other == kOthers.end()) return false;
  if (!answers.empty() && !other->takes_answers) throw Wrong(fmt::format("{} asks for nothing", other->name));
  (this->*other->press)(answers);
  return true;
}

void Menu::execute(Words words) {
  const std::string first = words.front();
  Words answers(words.begin() + 1, words.end());
  try {
    if (first.size() == 1 && !execute_key(stl::upper_case(first), answers))
      throw Wrong(fmt::format("'{}' is not a key; M shows the menu", stl::printable(first)));
    if (first.size() > 1) do_request({.words = words});
  } catch (const Wrong& wrong) {
    fmt::print("{}\n", stl::printable(wrong.what()));
  } catch (const SlaveUnreachable& unreachable) {
    fmt::print("{}\n", stl::printable(unreachable.what()));
    slave_.reset();  // what comes next tries to reach it again
  }
}

/// Ctrl-C ends what is going on, and the line being typed; nothing at the end of the input, and for all that ends the
/// command.
std::optional<std::string> Menu::read() {
  while (true) {
    if (forget_ctrl_c()) fmt::print("\n");
    if (interrupted()) return {};
    std::fflush(stdout);
    if (auto line = editor_.read()) return line;
    if (!interrupted()) return {};
  }
}

int Menu::run() {
  if (const auto done = screen_.switch_on(); !done) return print_error(done.why()), kUnusable;
  editor_.when_changed([this] { look_again(); });
  if (!keys_are_in_view()) fmt::print("M shows the menu, H helps, Q quits; Enter follows each key.\n");
  while (!quit_) {
    draw();
    const auto line = read();
    if (!line) break;
    if (Words words = stl::split_words(*line); !words.empty()) execute(std::move(words));
  }
  screen_.switch_off();
  fmt::print("{}", statistics_.text(options_.protocol->refusal));
  print_interruption();
  return interrupted() ? kCheckFailed : kFine;
}

}  // namespace

int run_menu(const MasterOptions& options, const MenuTarget& target) { return Menu(options, target).run(); }

}  // namespace s7200::tools
