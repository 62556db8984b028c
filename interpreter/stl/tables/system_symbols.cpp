#include "interpreter/stl/tables/system_symbols.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl {
namespace {

constexpr std::uint8_t kNoBit = 0xFF;

/// A symbol that exists once.
struct Single {
  std::string_view name;
  Size size;
  std::uint8_t number;
  std::uint8_t bit = kNoBit;
};

// clang-format off
constexpr Single kSingles[] = {
    {"Always_On",        Size::Bit,   0, 0},
    {"First_Scan_On",    Size::Bit,   0, 1},
    {"Retentive_Lost",   Size::Bit,   0, 2},
    {"RUN_Power_Up",     Size::Bit,   0, 3},
    {"Clock_60s",        Size::Bit,   0, 4},
    {"Clock_1s",         Size::Bit,   0, 5},
    {"Clock_Scan",       Size::Bit,   0, 6},
    {"Mode_Switch",      Size::Bit,   0, 7},
    {"Result_0",         Size::Bit,   1, 0},
    {"Overflow_Illegal", Size::Bit,   1, 1},
    {"Neg_Result",       Size::Bit,   1, 2},
    {"Divide_By_0",      Size::Bit,   1, 3},
    {"Table_Overflow",   Size::Bit,   1, 4},
    {"Table_Empty",      Size::Bit,   1, 5},
    {"Not_BCD",          Size::Bit,   1, 6},
    {"Not_Hex",          Size::Bit,   1, 7},
    {"Receive_Char",     Size::Byte,  2},
    {"Parity_Err",       Size::Bit,   3, 0},
    {"Comm_Int_Ovr",     Size::Bit,   4, 0},
    {"Input_Int_Ovr",    Size::Bit,   4, 1},
    {"Timed_Int_Ovr",    Size::Bit,   4, 2},
    {"RUN_Err",          Size::Bit,   4, 3},
    {"Int_Enable",       Size::Bit,   4, 4},
    {"Xmit0_Idle",       Size::Bit,   4, 5},
    {"Xmit1_Idle",       Size::Bit,   4, 6},
    {"Force_On",         Size::Bit,   4, 7},
    {"IO_Err",           Size::Bit,   5, 0},
    {"Too_Many_D_IO",    Size::Bit,   5, 1},
    {"Too_Many_A_IO",    Size::Bit,   5, 2},
    {"CPU_ID",           Size::Byte,  6},
    {"Last_Scan",        Size::Word, 22},
    {"Minimum_Scan",     Size::Word, 24},
    {"Maximum_Scan",     Size::Word, 26},
    {"Time_0_Intrvl",    Size::Byte, 34},
    {"Time_1_Intrvl",    Size::Byte, 35},
};

/// A symbol of each of several units, whose number stands for the # of its name.
struct Numbered {
  std::string_view name;
  Size size;
  std::vector<std::uint8_t> numbers;  ///< where it is in SM, by the number of the unit
  std::uint8_t bit = kNoBit;
  bool has_bits = false;  ///< P0_Config_3 and the like name its bits
};

const Numbered kNumbered[] = {
    {"EM#_ID",              Size::Byte, {8, 10, 12, 14, 16, 18, 20}},
    {"EM#_Err",             Size::Byte, {9, 11, 13, 15, 17, 19, 21}},

    {"P#_Config",           Size::Byte, {30, 130}, kNoBit, true},
    {"P#_Stat_Rcv",         Size::Byte, {86, 186}, kNoBit, true},
    {"P#_Ctrl_Rcv",         Size::Byte, {87, 187}, kNoBit, true},
    {"P#_Start_Char",       Size::Byte, {88, 188}},
    {"P#_End_Char",         Size::Byte, {89, 189}},
    {"P#_Idle_Time",        Size::Word, {90, 190}},
    {"P#_Timeout",          Size::Word, {92, 192}},
    {"P#_Max_Char",         Size::Byte, {94, 194}},

    {"HSC#_Status",         Size::Byte,   {36, 46, 56, 136, 146, 156}, kNoBit, true},
    {"HSC#_Ctrl",           Size::Byte,   {37, 47, 57, 137, 147, 157}},
    {"HSC#_Reset_Level",    Size::Bit,    {37, 47, 57, 137, 147, 157}, 0},
    {"HSC#_Start_Level",    Size::Bit,    {37, 47, 57, 137, 147, 157}, 1},
    {"HSC#_Rate",           Size::Bit,    {37, 47, 57, 137, 147, 157}, 2},
    {"HSC#_Dir",            Size::Bit,    {37, 47, 57, 137, 147, 157}, 3},
    {"HSC#_Dir_Update",     Size::Bit,    {37, 47, 57, 137, 147, 157}, 4},
    {"HSC#_PV_Update",      Size::Bit,    {37, 47, 57, 137, 147, 157}, 5},
    {"HSC#_CV_Update",      Size::Bit,    {37, 47, 57, 137, 147, 157}, 6},
    {"HSC#_Enable",         Size::Bit,    {37, 47, 57, 137, 147, 157}, 7},
    {"HSC#_CV",             Size::Double, {38, 48, 58, 138, 148, 158}},
    {"HSC#_PV",             Size::Double, {42, 52, 62, 142, 152, 162}},

    {"PTO#_Status",         Size::Byte,   {66, 76}},
    {"PLS#_Err_Abort",      Size::Bit,    {66, 76}, 4},
    {"PLS#_Cmd_Abort",      Size::Bit,    {66, 76}, 5},
    {"PLS#_Ovr",            Size::Bit,    {66, 76}, 6},
    {"PLS#_Idle",           Size::Bit,    {66, 76}, 7},
    {"PLS#_Ctrl",           Size::Byte,   {67, 77}},
    {"PLS#_Cycle_Update",   Size::Bit,    {67, 77}, 0},
    {"PWM#_PW_Update",      Size::Bit,    {67, 77}, 1},
    {"PTO#_PC_Update",      Size::Bit,    {67, 77}, 2},
    {"PLS#_TimeBase",       Size::Bit,    {67, 77}, 3},
    {"PWM#_Sync",           Size::Bit,    {67, 77}, 4},
    {"PTO#_Op",             Size::Bit,    {67, 77}, 5},
    {"PLS#_Select",         Size::Bit,    {67, 77}, 6},
    {"PLS#_Enable",         Size::Bit,    {67, 77}, 7},
    {"PLS#_Cycle",          Size::Word,   {68, 78}},
    {"PWM#_PW",             Size::Word,   {70, 80}},
    {"PTO#_PC",             Size::Double, {72, 82}},
    {"PTO#_Seg_Num",        Size::Byte,   {166, 176}},
    {"PTO#_Profile_Offset", Size::Word,   {168, 178}},
};
// clang-format on

/// Symbols for which the S7-200 has nothing; its SM0.7 is the mode switch, its SMB7 is reserved.
constexpr std::string_view kOnlyOfSmart[] = {"RTC_Lost", "CPU_IO"};

struct Points {
  std::string_view name;
  std::string_view area;
};
constexpr Points kPoints[] = {{"CPU_Input", "I"}, {"CPU_Output", "Q"}, {"CPU_输入", "I"}, {"CPU_输出", "Q"}};
constexpr std::uint32_t kMostPoints = 64;

Address special_memory(Size size, std::uint32_t number, std::uint8_t bit) {
  return {"SM", size, number, bit == kNoBit ? std::uint8_t{0} : bit};
}

void add(std::vector<Symbol>& table, std::string name, Address address) {
  table.push_back({std::move(name), std::move(address), {}, {}});
}

void add(std::vector<Symbol>& table, const Numbered& row) {
  for (std::size_t unit = 0; unit < row.numbers.size(); ++unit) {
    std::string name(row.name);
    name.replace(name.find('#'), 1, std::to_string(unit));
    for (std::uint8_t bit = 0; row.has_bits && bit < 8; ++bit)
      add(table, fmt::format("{}_{}", name, bit), special_memory(Size::Bit, row.numbers[unit], bit));
    add(table, std::move(name), special_memory(row.size, row.numbers[unit], row.bit));
  }
}

std::vector<Symbol> whole_table() {
  std::vector<Symbol> table;
  for (const Single& row : kSingles) add(table, std::string(row.name), special_memory(row.size, row.number, row.bit));
  for (const Numbered& row : kNumbered) add(table, row);
  for (const Points& points : kPoints)
    for (std::uint32_t i = 0; i < kMostPoints; ++i)
      add(table, fmt::format("{}{}", points.name, i),
          {std::string(points.area), Size::Bit, i / 8, static_cast<std::uint8_t>(i % 8)});
  for (const std::string_view name : kOnlyOfSmart) table.push_back({std::string(name), std::nullopt, {}, {}});
  return table;
}

}  // namespace

bool is_only_of_smart(std::string_view name) {
  constexpr std::size_t kLettersBefore = 3;  // CPU_, RTC_
  if (name.size() <= kLettersBefore || name[kLettersBefore] != '_') return false;
  const std::string upper = upper_case(name);
  const auto is_point = [&](const Points& points) {
    const std::string_view rest = std::string_view(upper).substr(std::min(points.name.size(), upper.size()));
    return upper.starts_with(upper_case(points.name)) && !rest.empty() && std::ranges::all_of(rest, is_digit);
  };
  return std::ranges::any_of(kOnlyOfSmart, [&](std::string_view each) { return upper_case(each) == upper; }) ||
         std::ranges::any_of(kPoints, is_point);
}

std::span<const Symbol> system_symbols() {
  static const std::vector<Symbol> kTable = whole_table();
  return kTable;
}

}  // namespace s7200::stl
