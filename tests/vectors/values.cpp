// Values to try, by mnemonic.
#include <bit>
#include <functional>
#include <limits>
#include <map>

#include "tests/vectors/cases.hpp"

namespace s7200::vectors {
namespace {

using List = std::vector<Values>;

std::uint32_t real(float value) { return std::bit_cast<std::uint32_t>(value); }

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();

/// Each of the values, one element for each operand.
List singles(std::initializer_list<std::vector<std::uint32_t>> tuples) {
  List list;
  for (const auto& tuple : tuples) {
    Values values;
    for (const std::uint32_t value : tuple) values.operand.push_back({value});
    list.push_back(values);
  }
  return list;
}

/// Each on every one of the stacks.
List on(const std::vector<Levels>& stacks, const List& list) {
  List result;
  for (const Values& values : list)
    for (const Levels& stack : stacks) {
      result.push_back(values);
      result.back().stack = stack;
    }
  return result;
}

List stacks_only(const std::vector<Levels>& stacks) { return on(stacks, {Values{}}); }

const std::vector<Levels> kBoth{{true}, {false}};
const std::vector<Levels> kPairs{{false, false, true}, {true, false, true}, {false, true}, {true, true}};
const std::vector<Levels> kLoads{{true}, {false, true}, {true, false, true, false, true, false, true, false, true}};

// --- compares ---

List compare_values(char type) {
  switch (type) {
    case 'B':
      return singles({{5, 5}, {4, 5}, {5, 4}, {0, 255}, {255, 0}, {128, 127}});
    case 'W':
      return singles({{5, 5}, {4, 5}, {5, 4}, {0xFFFF, 0}, {0x8000, 0x7FFF}, {0x7FFF, 0x8000}});
    case 'D':
      return singles({{5, 5}, {4, 5}, {5, 4}, {0xFFFF'FFFF, 0}, {0x8000'0000, 0x7FFF'FFFF}, {0x7FFF'FFFF, 0x8000'0000}});
    default:
      return singles({{real(2.5f), real(2.5f)},
                      {real(-1.5f), real(2.5f)},
                      {real(2.5f), real(-1.5f)},
                      {real(0.0f), real(-0.0f)},
                      {real(kNoNumber), real(kNoNumber)},
                      {real(1.0f), real(kNoNumber)},
                      {real(kNoNumber), real(1.0f)},
                      {real(kInfinity), real(kLargest)},
                      {real(-kInfinity), real(-kLargest)},
                      {real(kInfinity), real(kInfinity)}});
  }
}

List compare(std::string_view mnemonic) {
  const bool loads = mnemonic.starts_with("LD");
  const std::size_t prefix = loads ? 2 : 1;
  return on(loads ? std::vector<Levels>{{true}} : kBoth, compare_values(mnemonic[prefix]));
}

// --- the others ---

List word_sums() {
  return singles({{1, 2},
                  {0xFFFF, 1},
                  {1, 0x7FFF},
                  {0xFFFF, 0x8000},
                  {0x8000, 0x8000},
                  {0, 0},
                  {0x7FFF, 0x7FFF},
                  {5, 0xFFFB},
                  {1, 0x8000},
                  {0x8000, 0}});
}
List double_sums() {
  return singles({{1, 2},
                  {0xFFFF'FFFF, 1},
                  {1, 0x7FFF'FFFF},
                  {0xFFFF'FFFF, 0x8000'0000},
                  {0x8000'0000, 0x8000'0000},
                  {0, 0},
                  {0x7FFF'FFFF, 0x7FFF'FFFF},
                  {5, 0xFFFF'FFFB},
                  {1, 0x8000'0000},
                  {0x8000'0000, 0},
                  {1, 0xFFFF}});
}
List word_steps() { return singles({{0x1233}, {0}, {1}, {0xFFFF}, {0x7FFF}, {0x8000}}); }
List double_steps() { return singles({{0x1233}, {0}, {1}, {0xFFFF'FFFF}, {0x7FFF'FFFF}, {0x8000'0000}, {0xFFFF}}); }

List real_sums() {
  return singles({{real(1.5f), real(2.25f)},
                  {real(-1.5f), real(1.5f)},
                  {real(1.5f), real(1.5f)},
                  {real(2.0f), real(-8.0f)},
                  {real(0.0f), real(5.0f)},
                  {real(-0.0f), real(-5.0f)},
                  {real(kLargest), real(kLargest)},
                  {real(kLargest), real(-kLargest)},
                  {real(1e-30f), real(1e-30f)},
                  {real(kNoNumber), real(1.0f)},
                  {real(1.0f), real(kInfinity)},
                  {real(0.0f), real(kNoNumber)},
                  {real(0.0f), real(0.0f)},
                  {real(kInfinity), real(1.0f)},
                  {real(kInfinity), real(0.0f)}});
}

List word_logic() { return singles({{0xFF00, 0x0FF0}, {0, 0xFFFF}, {0xFFFF, 0xFFFF}, {0xAAAA, 0x5555}, {0, 0}}); }
List double_logic() {
  return singles(
      {{0xFFFF'0000, 0x00FF'FF00}, {0, 0xFFFF'FFFF}, {0xFFFF'FFFF, 0xFFFF'FFFF}, {0xAAAA'AAAA, 0x5555'5555}, {0, 0}});
}

List word_shifts() {
  return singles({{0x1234, 4},
                  {0x8001, 1},
                  {0x8001, 0},
                  {0x4000, 2},
                  {0x0002, 2},
                  {0xFFFF, 15},
                  {0x8001, 16},
                  {0xFFFF, 17},
                  {0x0001, 255},
                  {0, 3},
                  {0x8000, 32},
                  {0, 16},
                  {0, 0}});
}
List double_shifts() {
  return singles({{0x1234'5678, 4},
                  {0x8000'0001, 1},
                  {0x8000'0001, 0},
                  {0x4000'0000, 2},
                  {0x0000'0002, 2},
                  {0xFFFF'FFFF, 31},
                  {0x8000'0001, 32},
                  {0xFFFF'FFFF, 33},
                  {0x0000'0001, 255},
                  {0, 3},
                  {0x8000'0000, 64},
                  {0, 32},
                  {0, 0}});
}

List shift_register() {
  return {{{{1}, {0, 1, 0}, {3}}}, {{{0}, {1, 1, 1}, {3}}}, {{{1}, {0, 1, 1}, {0xFD}}}, {{{0}, {1, 0, 0}, {0xFD}}},
          {{{1}, {0}, {1}}},       {{{0}, {1}, {0xFF}}},    {{{1}, {1, 0}, {64}}},      {{{1}, {1, 0}, {0xC0}}}};
}

List table_adds() {
  return {{{{0x1234}, {2, 1, 0x1111, 0x2222}}},
          {{{0x1234}, {2, 0, 0x1111, 0x2222}}},
          {{{0x1234}, {2, 2, 0x1111, 0x2222}}},
          {{{0x1234}, {2, 3}}},
          {{{0x1234}, {0, 0}}},
          {{{0x1234}, {100, 99}}},
          {{{0x1234}, {101, 1}}},
          {{{0x1234}, {2, 0xFFFF}}}};
}
List table_takes() {
  return {{{{2, 1, 0x1111, 0x2222}, {0}}},
          {{{2, 2, 0x1111, 0x2222}, {0}}},
          {{{4, 3, 0x1111, 0x2222, 0x3333, 0x4444}, {0}}},
          {{{2, 0, 0x1111, 0x2222}, {5}}},
          {{{2, 3}, {5}}},
          {{{0, 0}, {5}}},
          {{{101, 1}, {5}}}};
}
List table_finds() {
  const Elements entries{3, 7, 0xFFFF, 9};
  return {{{{2, 7, 9}, {7}, {0}}},    {{entries, {7}, {0}}},      {{entries, {7}, {1}}},   {{entries, {9}, {0}}},
          {{entries, {0xFFFF}, {0}}}, {{entries, {0}, {0}}},      {{entries, {100}, {0}}}, {{entries, {0x8000}, {0}}},
          {{entries, {7}, {3}}},      {{entries, {7}, {0xFFFF}}}, {{{0}, {7}, {0}}},       {{{101}, {7}, {0}}}};
}

Elements characters(std::string_view text) { return {text.begin(), text.end()}; }

/// A string: its length and its characters.
Elements string(std::string_view text) {
  Elements elements{static_cast<std::uint32_t>(text.size())};
  elements.insert(elements.end(), text.begin(), text.end());
  return elements;
}

const Elements kTooLong{255};

List word_products() {
  return singles(
      {{3, 4}, {0xFFFF, 5}, {0, 7}, {200, 200}, {0x8000, 0xFFFF}, {0xFF49, 0x00B3}, {2, 0x4000}, {0xFFFF, 0x7FFF}});
}
List double_products() {
  return singles({{3, 4},
                  {0xFFFF'FFFF, 5},
                  {0, 7},
                  {0x1'0000, 0x1'0000},
                  {0x8000'0000, 0xFFFF'FFFF},
                  {2, 0x4000'0000},
                  {0xFFFF, 0x8000}});
}
List word_quotients() {
  return singles(
      {{7, 100}, {7, 0xFF9C}, {0xFFF9, 100}, {0, 100}, {0xFFFF, 0x8000}, {100, 7}, {0xFFFF, 0x7FFF}, {1, 0x8000}});
}
List double_quotients() {
  return singles({{7, 100},
                  {7, 0xFFFF'FF9C},
                  {0xFFFF'FFF9, 100},
                  {0, 100},
                  {0xFFFF'FFFF, 0x8000'0000},
                  {100, 7},
                  {0xFFFF'FFFF, 0x7FFF'FFFF},
                  {0x1'0000, 0x7FFF'FFFF}});
}

List byte_logic() { return singles({{0xF0, 0x3C}, {0, 0xFF}, {0xFF, 0xFF}, {0xAA, 0x55}, {0, 0}}); }
List byte_shifts() {
  return singles({{0x12, 4},
                  {0x81, 1},
                  {0x81, 0},
                  {0x40, 2},
                  {0x02, 2},
                  {0xFF, 7},
                  {0x81, 8},
                  {0xFF, 9},
                  {0x01, 255},
                  {0, 3},
                  {0x80, 16},
                  {0, 8},
                  {0, 0}});
}

List angles() {
  return singles({{real(0.5f), 0},
                  {real(0.0f), 1},
                  {real(-0.0f), 1},
                  {real(-1.0f), 0},
                  {real(3.14159265f), 1},
                  {real(1.57079633f), 1},
                  {real(1e10f), 1},
                  {real(1e-40f), 1},
                  {real(kNoNumber), 1},
                  {real(kInfinity), 1},
                  {real(-kInfinity), 1}});
}

/// A number, and a format.
List numbers_as_text(std::size_t size, const std::vector<std::uint32_t>& numbers) {
  List list;
  const Elements out(size, 0x2A);
  for (const std::uint32_t format : {3u, 0u, 8u, 11u, 5u, 13u, 6u, 7u, 0x10u, 0x83u})
    for (const std::uint32_t number : numbers)
      if (list.size() < numbers.size() || number == numbers[0] || number == numbers[1])
        list.push_back({{{number}, out, {format}}});
  for (const std::uint32_t number : numbers) list.push_back({{{number}, out, {0}}});
  return list;
}

List reals_as_text() {
  List list;
  const auto add = [&](float value, std::uint32_t format) {
    list.push_back({{{real(value)}, Elements(16, 0x2A), {format}}});
  };
  // The example of the manual: six characters, one decimal.
  for (const float value : {1234.5f, -0.0004f, -3.67526f, 1.95f, 12345.6f, -1234.5f}) add(value, 0x61);
  for (const std::uint32_t format : {0x30u, 0x31u, 0x20u, 0x00u, 0x41u, 0x32u, 0x52u, 0xF5u, 0xFDu, 0xF6u, 0x84u, 0x85u})
    add(2.5f, format);
  for (const float value : {0.5f, 1.5f, -0.5f, 0.0f, -0.0f, 999.5f, 1e10f, 1e20f, kNoNumber, kInfinity}) add(value, 0x40);
  for (const float value : {0.005f, 0.015625f, -123.456f, 16777216.0f, 1e-40f, 99.90625f}) add(value, 0xF5);
  return list;
}

List strings_as_numbers(std::initializer_list<std::string_view> texts) {
  List list;
  for (const std::string_view text : texts) list.push_back({{string(text), {1}, {7}}});
  list.push_back({{string("AB-12C"), {3}, {7}}});
  list.push_back({{string("123"), {3}, {7}}});
  list.push_back({{string("123"), {4}, {7}}});
  list.push_back({{string("123"), {255}, {7}}});
  list.push_back({{string("123"), {0}, {7}}});
  list.push_back({{kTooLong, {1}, {7}}});
  return list;
}

List string_finds() {
  return {
      {{string("HALLO"), string("L"), {1}}},  {{string("HALLO"), string("LO"), {1}}}, {{string("HALLO"), string("L"), {4}}},
      {{string("HALLO"), string("L"), {5}}},  {{string("HALLO"), string("X"), {1}}},  {{string("HALLO"), string("OL"), {1}}},
      {{string("HALLO"), string("H"), {1}}},  {{string("HALLO"), string("H"), {2}}},  {{string("HALLO"), string("O"), {5}}},
      {{string("HALLO"), string("O"), {6}}},  {{string("HALLO"), string(""), {1}}},   {{string(""), string("A"), {1}}},
      {{string("LO"), string("HALLO"), {1}}}, {{string("HALLO"), string("L"), {0}}},  {{kTooLong, string("L"), {1}}},
      {{string("HALLO"), kTooLong, {1}}}};
}

List string_compares() {
  return {{{string("ABC"), string("ABC")}}, {{string("ABC"), string("ABD")}}, {{string("AB"), string("ABC")}},
          {{string("ABC"), string("AB")}},  {{string(""), string("")}},       {{string(""), string("A")}},
          {{string("BBC"), string("ABC")}}, {{kTooLong, string("A")}},        {{string("A"), kTooLong}}};
}

List seven_segments() {
  List list;
  for (std::uint32_t digit = 0; digit < 16; ++digit) list.push_back({{{digit}, {0}}});
  list.push_back({{{0xF5}, {0xFF}}});
  return list;
}

const std::map<std::string_view, std::function<List()>>& lists() {
  static const std::map<std::string_view, std::function<List()>> kLists{
      {"LD",
       [] {
         return on(kLoads, singles({{1}, {0}}));
       }},
      {"A",
       [] {
         return on(kBoth, singles({{1}, {0}}));
       }},
      {"S",
       [] {
         return List{{{{0, 1, 0}, {3}}}, {{{0}, {1}}}, {{{0, 0}, {255}}}};
       }},
      {"R",
       [] {
         return List{{{{1, 0, 1}, {3}}}, {{{1}, {1}}}, {{{1, 1}, {255}}}};
       }},
      {"SI",
       [] {
         return List{{{{0, 1, 0}, {3}}}, {{{0}, {1}}}, {{{0, 0}, {60}}}};
       }},
      {"RI",
       [] {
         return List{{{{1, 0, 1}, {3}}}, {{{1}, {1}}}, {{{1, 1}, {60}}}};
       }},
      {"=",
       [] {
         return on(kBoth, singles({{0}, {1}}));
       }},
      {"NOT", [] { return stacks_only(kBoth); }},
      {"ALD", [] { return stacks_only(kPairs); }},
      {"LPS", [] { return stacks_only(kLoads); }},
      {"LPP",
       [] {
         return stacks_only({{true, false, true}, {false, true}, {true, true, true, true, true, true, true, true, true}});
       }},
      {"EU", [] { return stacks_only(kBoth); }},
      {"NOP", [] { return List{{{{0}}}}; }},
      {"MOVB",
       [] {
         return singles({{0x12, 0x34}, {0, 0xFF}, {0xFF, 0}});
       }},
      {"MOVW",
       [] {
         return singles({{0x1234, 0}, {0, 0xFFFF}, {0xFFFF, 0}, {0x8000, 0x7FFF}});
       }},
      {"MOVD",
       [] {
         return singles({{0x1234'5678, 0}, {0, 0xFFFF'FFFF}, {0xFFFF'FFFF, 0}});
       }},
      {"MOVR",
       [] {
         return singles({{real(2.5f), 0}, {real(-0.0f), 0}, {real(kNoNumber), 0}});
       }},
      {"BMB",
       [] {
         return List{{{{0x11, 0x22, 0x33}, {0xAA, 0xBB, 0xCC}, {3}}}, {{{0x11}, {0xAA}, {1}}}, {{{0x11}, {0xAA}, {255}}}};
       }},
      {"BMW",
       [] {
         return List{{{{0x1111, 0x2222, 0x3333}, {0xAAAA, 0xBBBB, 0xCCCC}, {3}}},
                     {{{0x1111}, {0xAAAA}, {1}}},
                     {{{0x1111}, {0xAAAA}, {255}}}};
       }},
      {"FILL",
       [] {
         return List{{{{0x1234}, {0xAAAA, 0xBBBB, 0xCCCC}, {3}}}, {{{0x1234}, {0xAAAA}, {1}}}};
       }},
      {"SWAP",
       [] {
         return singles({{0x1234}, {0x00FF}, {0x8080}});
       }},
      {"+I", word_sums},
      {"-I", word_sums},
      {"+D", double_sums},
      {"-D", double_sums},
      {"INCW", word_steps},
      {"DECW", word_steps},
      {"INCD", double_steps},
      {"DECD", double_steps},
      {"MUL",
       [] {
         return singles({{3, 0xFFFF'0004}, {0x8000, 0x8000}, {0xFFFF, 2}, {0, 7}, {0x7FFF, 0x7FFF}, {0xFFFF, 0xFFFF}});
       }},
      {"DIV",
       [] {
         return singles({{7, 100},
                         {7, 0xFF9C},
                         {0xFFF9, 100},
                         {0xFFF9, 0xFF9C},
                         {0, 100},
                         {0xFFFF, 0x8000},
                         {100, 7},
                         {1, 0},
                         {10, 0xABCD'0065}});
       }},
      {"+R", real_sums},
      {"-R", real_sums},
      {"*R", real_sums},
      {"/R", real_sums},
      {"SQRT",
       [] {
         return singles({{real(4.0f), 0},
                         {real(2.0f), 0},
                         {real(0.0f), 1},
                         {real(-0.0f), 1},
                         {real(-1.0f), 1},
                         {real(kNoNumber), 1},
                         {real(kInfinity), 1},
                         {real(1e-40f), 1}});
       }},
      {"ANDW", word_logic},
      {"ORW", word_logic},
      {"XORW", word_logic},
      {"ANDD", double_logic},
      {"ORD", double_logic},
      {"XORD", double_logic},
      {"INVW",
       [] {
         return singles({{0x1234}, {0}, {0xFFFF}});
       }},
      {"INVD",
       [] {
         return singles({{0x1234'5678}, {0}, {0xFFFF'FFFF}});
       }},
      {"SLW", word_shifts},
      {"SRW", word_shifts},
      {"RLW", word_shifts},
      {"RRW", word_shifts},
      {"SLD", double_shifts},
      {"SRD", double_shifts},
      {"RLD", double_shifts},
      {"RRD", double_shifts},
      {"SHRB", shift_register},
      {"BCDI",
       [] {
         return singles({{0x1234}, {0x9999}, {0}, {0x00A0}, {0xA000}, {0xFFFF}});
       }},
      {"IBCD",
       [] {
         return singles({{1234}, {9999}, {10000}, {0}, {0xFFFF}, {0x8000}, {1000}, {9000}});
       }},
      {"DTR",
       [] {
         return singles({{1, 0}, {0, 1}, {0xFFFF'FFFF, 0}, {16'777'217, 0}, {0x7FFF'FFFF, 0}, {0x8000'0000, 0}});
       }},
      {"TRUNC",
       [] {
         return singles({{real(2.5f), 0},
                         {real(-2.9f), 0},
                         {real(0.5f), 1},
                         {real(-0.0f), 1},
                         {real(2147483520.0f), 0},
                         {real(2147483648.0f), 0},
                         {real(-2147483648.0f), 0},
                         {real(-2147483904.0f), 0},
                         {real(kNoNumber), 0},
                         {real(kInfinity), 0}});
       }},
      {"DECO",
       [] {
         return singles({{3, 0xFFFF}, {0, 0}, {15, 0}, {0x1F, 0}});
       }},
      {"ENCO",
       [] {
         return singles({{0x0008, 0xA5}, {0, 0xA5}, {1, 0xA5}, {0x8000, 0}, {0x00C0, 0xFF}, {0xFFFF, 0xFF}});
       }},
      {"SEG", seven_segments},
      {"ATH",
       [] {
         return List{{{characters("3EA"), {0xFF, 0xFF}, {3}}}, {{characters("3E"), {0, 0}, {2}}},
                     {{characters("F"), {0x99}, {1}}},         {{characters("9AGF"), {0x55, 0x55}, {4}}},
                     {{characters("1a"), {0x55}, {2}}},        {{characters("/0"), {0x55}, {2}}},
                     {{characters("0:"), {0x55}, {2}}},        {{characters("@A"), {0x55}, {2}}}};
       }},
      {"HTA",
       [] {
         return List{{{{0x3E, 0xA1}, {0, 0, 0}, {3}}}, {{{0x09, 0xAF}, {0, 0, 0, 0}, {4}}}, {{{0xF0}, {0}, {1}}}};
       }},
      {"ATT", table_adds},
      {"FIFO", table_takes},
      {"LIFO", table_takes},
      {"FND=", table_finds},
      {"FND<>", table_finds},
      {"FND<", table_finds},
      {"FND>", table_finds},
      {"TON",
       [] {
         return on(kBoth, singles({{7, 10}, {7, 0}, {7, 0xFFFF}}));
       }},
      {"TONR",
       [] {
         return on(kBoth, singles({{7, 10}, {10, 10}, {7, 0x8000}}));
       }},
      {"CTU",
       [] {
         return on({{false, true}, {false, false}, {true, true}}, singles({{7, 10}, {10, 10}, {0x8000, 0x8001}}));
       }},
      {"CTUD",
       [] {
         return on({{false, true, true}, {false, false, true}, {true, true, true}}, singles({{7, 10}, {10, 10}}));
       }},
      {"*I", word_products},
      {"*D", double_products},
      {"/I", word_quotients},
      {"/D", double_quotients},
      {"ANDB", byte_logic},
      {"ORB", byte_logic},
      {"XORB", byte_logic},
      {"INVB",
       [] {
         return singles({{0x12}, {0}, {0xFF}});
       }},
      {"SLB", byte_shifts},
      {"SRB", byte_shifts},
      {"RLB", byte_shifts},
      {"RRB", byte_shifts},
      {"INCB",
       [] {
         return singles({{0x12}, {0}, {1}, {0xFF}, {0x7F}, {0x80}});
       }},
      {"DECB",
       [] {
         return singles({{0x12}, {0}, {1}, {0xFF}, {0x7F}, {0x80}});
       }},
      {"BMD",
       [] {
         return List{{{{0x1111'1111, 0x2222'2222}, {0xAAAA'AAAA, 0xBBBB'BBBB}, {2}}},
                     {{{0x1111'1111}, {0xAAAA'AAAA}, {1}}},
                     {{{0x1111'1111}, {0xAAAA'AAAA}, {255}}}};
       }},
      {"SIN", angles},
      {"COS", angles},
      {"TAN", angles},
      {"LN",
       [] {
         return singles({{real(2.0f), 0},
                         {real(1.0f), 1},
                         {real(0.5f), 1},
                         {real(0.0f), 1},
                         {real(-0.0f), 1},
                         {real(-1.0f), 1},
                         {real(1e-40f), 1},
                         {real(kLargest), 1},
                         {real(kInfinity), 1},
                         {real(kNoNumber), 1}});
       }},
      {"EXP",
       [] {
         return singles({{real(1.0f), 0},
                         {real(0.0f), 1},
                         {real(-1.0f), 1},
                         {real(88.7f), 1},
                         {real(88.8f), 1},
                         {real(-200.0f), 1},
                         {real(-kInfinity), 1},
                         {real(kNoNumber), 1}});
       }},
      {"ROUND",
       [] {
         return singles({{real(2.5f), 0},
                         {real(-2.5f), 0},
                         {real(2.4f), 0},
                         {real(0.5f), 1},
                         {real(-0.4f), 1},
                         {real(0.49999997f), 1},
                         {real(8388609.0f), 1},
                         {real(2147483520.0f), 0},
                         {real(2147483648.0f), 0},
                         {real(-2147483648.0f), 0},
                         {real(-2147483904.0f), 0},
                         {real(kNoNumber), 0},
                         {real(kInfinity), 0}});
       }},
      {"BTI",
       [] {
         return singles({{0x12, 0xFFFF}, {0, 0xFFFF}, {0x80, 0}, {0xFF, 0}});
       }},
      {"ITB",
       [] {
         return singles({{0x12, 0xFF}, {0, 0xFF}, {0xFF, 0}, {0x100, 0x55}, {0xFFFF, 0x55}, {0x8000, 0x55}});
       }},
      {"ITD",
       [] {
         return singles({{0x1234, 0}, {0, 0xFFFF'FFFF}, {0x7FFF, 0}, {0x8000, 0}, {0xFFFF, 0}});
       }},
      {"DTI",
       [] {
         return singles({{0x12, 0},
                         {0, 0xFFFF},
                         {0x7FFF, 0},
                         {0x8000, 0x55},
                         {0xFFFF'8000, 0},
                         {0xFFFF'7FFF, 0x55},
                         {0x7FFF'FFFF, 0x55},
                         {0x8000'0000, 0x55},
                         {0xFFFF'FFFF, 0}});
       }},
      {"ITA",
       [] {
         return numbers_as_text(8, {12, 0xFF85, 1234, 0xCFC7, 0, 0x8000, 0x7FFF});
       }},
      {"DTA",
       [] {
         return numbers_as_text(12, {12, 0xFFFE'9C9D, 1234567, 0, 0x8000'0000, 0x7FFF'FFFF});
       }},
      {"ITS",
       [] {
         return numbers_as_text(9, {12, 0xFF85, 1234, 0xCFC7, 0, 0x8000, 0x7FFF});
       }},
      {"DTS",
       [] {
         return numbers_as_text(13, {12, 0xFFFE'9C9D, 1234567, 0, 0x8000'0000, 0x7FFF'FFFF});
       }},
      {"RTA", reals_as_text},
      {"RTS", reals_as_text},
      {"STI",
       [] {
         return strings_as_numbers({"123", "-00456", "123.45", "+2345", "00012ABCD", "32767", "32768", "-32768", "-32769",
                                    "  7", "A1", "", "++1", "+-1", "+ 1", "-", "99999999"});
       }},
      {"STD",
       [] {
         return strings_as_numbers({"123", "-00456", "123.45", "+2345", "40000", "  7", "A1", "", "+-1", "-"});
       }},
      {"STR",
       [] {
         return strings_as_numbers(
             {"123", "-00456", "123.45", "+2345", "1,5", ".5", "5.", ".", "-", "", "1.2.3", "1E5", "  -0.1", "A1", "-0"});
       }},
      {"SLEN",
       [] {
         return List{{{string("HALLO"), {0}}}, {{string(""), {9}}}, {{{254}, {0}}}, {{kTooLong, {9}}}};
       }},
      {"SCPY",
       [] {
         return List{
             {{string("HALLO"), string("AB")}}, {{string(""), string("AB")}}, {{{254, 1, 2}, {0}}}, {{kTooLong, {0}}}};
       }},
      {"SCAT",
       [] {
         return List{{{string("DE"), string("ABC")}}, {{string(""), string("ABC")}}, {{string("DE"), string("")}},
                     {{string("D"), {253}}},          {{string("D"), {254}}},        {{kTooLong, {0}}},
                     {{string("D"), kTooLong}}};
       }},
      {"SFND", string_finds},
      {"CFND", string_finds},
      {"LDS",
       [] {
         return on({{true, false, true, false, false, false, true, false, true}, {false, true}},
                   singles({{0}, {1}, {2}, {8}}));
       }},
      {"AENO", [] { return stacks_only(kBoth); }},
      {"BIR",
       [] {
         return singles({{0x5A, 0}, {0, 0xFF}});
       }},
      {"BIW",
       [] {
         return singles({{0x5A, 0}, {0, 0xFF}, {0xFF, 0}});
       }},
      {"BITIM", [] { return singles({{5}}); }},
      {"CITIM",
       [] {
         return singles({{5, 7}, {0, 7}});
       }},
      {"TOF",
       [] {
         return on(kBoth, singles({{7, 10}, {7, 0}, {7, 0xFFFF}}));
       }},
      {"CTD",
       [] {
         return on({{false, true}, {false, false}, {true, true}}, singles({{7, 10}, {0, 10}, {1, 10}, {0x8000, 0x8001}}));
       }},
      {"WDR", [] { return stacks_only({{true}}); }},
  };
  return kLists;
}

/// Mnemonics with the values of another.
std::string_view like(std::string_view mnemonic) {
  static const std::map<std::string_view, std::string_view> kLike{
      {"LDN", "LD"}, {"LDI", "LD"}, {"LDNI", "LD"}, {"AN", "A"},    {"AI", "A"},    {"ANI", "A"},
      {"O", "A"},    {"ON", "A"},   {"OI", "A"},    {"ONI", "A"},   {"OLD", "ALD"}, {"LRD", "ALD"},
      {"=I", "="},   {"ED", "EU"},  {"ENI", "WDR"}, {"DISI", "WDR"}};
  const auto found = kLike.find(mnemonic);
  return found == kLike.end() ? mnemonic : found->second;
}

}  // namespace

std::vector<Values> values_of(std::string_view mnemonic) {
  if (const Instruction* instruction = find_instruction(mnemonic);
      instruction && instruction->structure == Structure::Compare)
    return mnemonic.ends_with("S=") || mnemonic.ends_with("S<>")
               ? on(mnemonic.starts_with("LD") ? std::vector<Levels>{{true}} : kBoth, string_compares())
               : compare(mnemonic);
  const auto found = lists().find(like(mnemonic));
  return found == lists().end() ? List{} : found->second();
}

}  // namespace s7200::vectors
