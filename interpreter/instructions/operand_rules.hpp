// What may be written for an operand: the vocabulary of the table. Facts 6; the areas there are inferred from the manuals'
// operand lists.
//
// A name says what the manual calls the operand, and how the instruction reads it: BYTE, WORD and DWORD are bits, and any
// number that fits may be written for them; USINT has no sign, INT and DINT have one.
#pragma once

#include "interpreter/model/instruction.hpp"

namespace s7200::operands {

inline constexpr Areas kInputs = set_of(Area::I), kOutputs = set_of(Area::Q), kSegments = set_of(Area::S);
inline constexpr Areas kAnalogInputs = set_of(Area::AI), kAnalogOutputs = set_of(Area::AQ);
inline constexpr Areas kLocal = set_of(Area::L);  // of the CPUs that have it
inline constexpr Areas kTimers = set_of(Area::T), kCounters = set_of(Area::C);
inline constexpr Areas kMemory =
    kInputs | kOutputs | kSegments | set_of(Area::M) | set_of(Area::SM) | set_of(Area::V) | kLocal;
inline constexpr Areas kMemoryTC = kMemory | kTimers | kCounters;                                       // bits, words
inline constexpr Areas kValue = kMemory | set_of(Area::AC), kWordValue = kMemoryTC | set_of(Area::AC);  // others, words
inline constexpr Areas kReadWord = kWordValue | kAnalogInputs, kWriteWord = kWordValue | kAnalogOutputs;
inline constexpr Areas kLasting = kMemory & ~kLocal;  // XMT and RCV use it long after their routine has ended
inline constexpr Areas kVMemory = set_of(Area::V), kVAndM = kVMemory | set_of(Area::M), kStringMemory = kVMemory | kLocal;
inline constexpr Areas kReadDword = kValue | set_of(Area::HC);

inline constexpr std::int64_t kLargestByte = 255;

/// The same rule under another name, for an operand that the manual calls something else.
constexpr OperandRule named(std::string_view name, OperandRule rule) {
  rule.name = name;
  return rule;
}

// clang-format off

// --- bits; S, R and SHRB work on as many as the count says ---

inline constexpr OperandRule
    kBit          {.name = "BIT",   .width = Width::Bit,                      .areas = kMemoryTC},
    kDataBit      {.name = "DATA",  .width = Width::Bit,                      .areas = kMemoryTC},
    kInputPoint   {.name = "BIT",   .width = Width::Bit,                      .areas = kInputs},
    kSegmentIn    {.name = "BIT",   .width = Width::Bit,                      .areas = kSegments},
    kSegmentOut   {.name = "BIT",   .width = Width::Bit, .role = Role::Out,   .areas = kSegments},
    kBitOut       {.name = "BIT",   .width = Width::Bit, .role = Role::Out,   .areas = kMemoryTC},
    kOutputPoint  {.name = "BIT",   .width = Width::Bit, .role = Role::Out,   .areas = kOutputs},
    kBits         {.name = "BIT",   .width = Width::Bit, .role = Role::Out,   .areas = kMemoryTC, .counted = 1},
    kOutputPoints {.name = "BIT",   .width = Width::Bit, .role = Role::Out,   .areas = kOutputs,  .counted = 1},
    kShiftRegister{.name = "S_BIT", .width = Width::Bit, .role = Role::InOut, .areas = kMemoryTC, .counted = 1};

// --- values that are read ---

inline constexpr OperandRule
    kInByte          {.name = "IN", .width = Width::Byte,   .areas = kValue,     .constant = true, .pointer = true},
    kInUsint         {.name = "IN", .width = Width::Byte,   .areas = kValue,     .constant = true, .pointer = true,                                 .sign = Sign::Unsigned},
    kInWord          {.name = "IN", .width = Width::Word,   .areas = kReadWord,  .constant = true, .pointer = true},
    kInInt           {.name = "IN", .width = Width::Word,   .areas = kReadWord,  .constant = true, .pointer = true,                                 .sign = Sign::Signed},
    kInDword         {.name = "IN", .width = Width::Double, .areas = kReadDword, .constant = true, .pointer = true},
    kInDint          {.name = "IN", .width = Width::Double, .areas = kReadDword, .constant = true, .pointer = true,                                 .sign = Sign::Signed},
    kInDwordOrAddress{.name = "IN", .width = Width::Double, .areas = kReadDword, .constant = true, .pointer = true, .address_of = true},
    kInReal          {.name = "IN", .width = Width::Double, .areas = kValue,     .constant = true, .pointer = true,                    .real = true};

inline constexpr OperandRule
    kIn1Byte  = named("IN1", kInByte),  kIn2Byte  = named("IN2", kInByte),
    kIn1Usint = named("IN1", kInUsint), kIn2Usint = named("IN2", kInUsint),
    kIn1Word  = named("IN1", kInWord),  kIn2Word  = named("IN2", kInWord),
    kIn1Int   = named("IN1", kInInt),   kIn2Int   = named("IN2", kInInt),
    kIn1Dword = named("IN1", kInDword), kIn2Dword = named("IN2", kInDword),
    kIn1Dint  = named("IN1", kInDint),  kIn2Dint  = named("IN2", kInDint),
    kIn1Real  = named("IN1", kInReal),  kIn2Real  = named("IN2", kInReal);

inline constexpr OperandRule
    kDataWord    = named("DATA", kInWord),
    kPatternWord = named("PATRN", kInWord),
    kPatternInt  = named("PATRN", kInInt),
    kInitial     = named("INIT", kInInt),
    kFinal       = named("FINAL", kInInt),
    kPresetInt   = named("PV", kInInt);

// How far timers and counters count. With 0 and below there is nothing to count.
inline constexpr OperandRule
    kPresetTime{.name = "PT", .width = Width::Word, .areas = kReadWord, .constant = true, .pointer = true, .sign = Sign::Signed, .max = 32767, .usual_from = 1},
    kPresetValue = named("PV", kPresetTime);

// --- counts and places: bytes that are read ---

inline constexpr OperandRule
    // How many elements the blocks of the instruction have.
    kCount     {.name = "N",   .width = Width::Byte, .areas = kValue, .constant = true, .pointer = true, .sign = Sign::Unsigned, .min = 1,   .max = kLargestByte,                   .count = true},
    kLength    {.name = "LEN", .width = Width::Byte, .areas = kValue, .constant = true, .pointer = true, .sign = Sign::Unsigned, .min = 0,   .max = kLargestByte,                   .count = true},
    // SHRB: the sign is the direction, and 0 bits are count error 0092.
    kShiftCount{.name = "N",   .width = Width::Byte, .areas = kValue, .constant = true, .pointer = true, .sign = Sign::Signed,   .min = -64, .max = 64,           .not_zero = true, .count = true},
    // The number of places to shift. More than the width is not a mistake: a shift stops there, a rotate takes it modulo the
    // width.
    kPlaces    {.name = "N",   .width = Width::Byte, .areas = kValue, .constant = true, .pointer = true, .sign = Sign::Unsigned, .min = 0,   .max = kLargestByte};

// --- values that are written; InOut: those of two-operand arithmetic are source and destination ---

inline constexpr OperandRule
    kOutByte        {.name = "OUT", .width = Width::Byte,   .role = Role::Out,   .areas = kValue,     .pointer = true},
    kOutWord        {.name = "OUT", .width = Width::Word,   .role = Role::Out,   .areas = kWordValue, .pointer = true},
    kOutWordOrAnalog{.name = "OUT", .width = Width::Word,   .role = Role::Out,   .areas = kWriteWord, .pointer = true},
    kOutDword       {.name = "OUT", .width = Width::Double, .role = Role::Out,   .areas = kValue,     .pointer = true},
    kOutReal        {.name = "OUT", .width = Width::Double, .role = Role::Out,   .areas = kValue,     .pointer = true, .real = true},
    kInOutByte      {.name = "OUT", .width = Width::Byte,   .role = Role::InOut, .areas = kValue,     .pointer = true},
    kInOutWord      {.name = "OUT", .width = Width::Word,   .role = Role::InOut, .areas = kWordValue, .pointer = true},
    kInOutDword     {.name = "OUT", .width = Width::Double, .role = Role::InOut, .areas = kValue,     .pointer = true},
    kInOutReal      {.name = "OUT", .width = Width::Double, .role = Role::InOut, .areas = kValue,     .pointer = true, .real = true};

inline constexpr OperandRule
    kLoopIndex = named("INDX", kOutWord),
    kFindIndex = named("INDX", kInOutWord),
    kSwapped   = named("IN", kInOutWord),
    kDataOut   = named("DATA", kOutWordOrAnalog);

inline constexpr OperandRule
    kFormat     = named("FMT", kInByte),
    kAddressIn  = named("ADDR", kInByte),
    kAddressOut = named("ADDR", kOutByte),
    kIndexInOut = named("OUT", kInOutByte);

// Operands that the manual counts from 1.
inline constexpr OperandRule
    kIndex{.name = "INDX", .width = Width::Byte, .areas = kValue, .constant = true, .pointer = true, .sign = Sign::Unsigned, .min = 1, .max = kLargestByte};

// Eight points at once: a pointer must point to them, too.
inline constexpr OperandRule
    kInputByte {.name = "IN",  .width = Width::Byte,                    .areas = kInputs,  .pointer = true},
    kOutputByte{.name = "OUT", .width = Width::Byte, .role = Role::Out, .areas = kOutputs, .pointer = true};

// --- blocks: as many elements as the count says; a byte holds two hexadecimal digits ---

inline constexpr OperandRule
    kInBytes  {.name = "IN",  .width = Width::Byte,                      .areas = kMemory,                    .pointer = true, .counted = 1},
    kInWords  {.name = "IN",  .width = Width::Word,                      .areas = kMemoryTC | kAnalogInputs,  .pointer = true, .counted = 1},
    kInDwords {.name = "IN",  .width = Width::Double,                    .areas = kMemory,                    .pointer = true, .counted = 1},
    kInDigits {.name = "IN",  .width = Width::Byte,                      .areas = kMemory,                    .pointer = true, .counted = 2},
    kOutBytes {.name = "OUT", .width = Width::Byte,   .role = Role::Out, .areas = kMemory,                    .pointer = true, .counted = 1},
    kOutWords {.name = "OUT", .width = Width::Word,   .role = Role::Out, .areas = kMemoryTC | kAnalogOutputs, .pointer = true, .counted = 1},
    kOutDwords{.name = "OUT", .width = Width::Double, .role = Role::Out, .areas = kMemory,                    .pointer = true, .counted = 1},
    kOutDigits{.name = "OUT", .width = Width::Byte,   .role = Role::Out, .areas = kMemory,                    .pointer = true, .counted = 2};

// --- tables and buffers: at least so many elements, whatever they hold; and at most so many bytes ---

// Their number and 100 entries, a table's length before them; a length and what it counts; a head and 16 bytes of data.
inline constexpr std::uint16_t kMostOfEntries = 2 + 2 * 100, kMostOfTable = 2 + kMostOfEntries;
inline constexpr std::uint16_t kMostOfMessage = 1 + 255, kMostOfString = 1 + 254, kMostOfNetwork = 7 + 16;

inline constexpr OperandRule
    // A table: its length, the number of its entries, and at least one of them; FND gets the number of entries and the rest
    // after it.
    kTable   {.name = "TBL", .width = Width::Word, .role = Role::InOut, .areas = kMemoryTC, .pointer = true, .elements = 3,  .most = kMostOfTable},
    kEntries {.name = "SRC", .width = Width::Word,                      .areas = kMemoryTC, .pointer = true,                 .most = kMostOfEntries},
    kPidLoop {.name = "TBL", .width = Width::Byte, .role = Role::InOut, .areas = kVMemory,                   .elements = 36},  // nine reals
    kMessage {.name = "TBL", .width = Width::Byte,                      .areas = kLasting,  .pointer = true,                 .most = kMostOfMessage},
    kReceived{.name = "TBL", .width = Width::Byte, .role = Role::Out,   .areas = kLasting,  .pointer = true,                 .most = kMostOfMessage},
    kNetwork {.name = "TBL", .width = Width::Byte, .role = Role::InOut, .areas = kVAndM,    .pointer = true, .elements = 8,  .most = kMostOfNetwork},  // with a byte of data
    kClockIn {.name = "T",   .width = Width::Byte,                      .areas = kMemory,   .pointer = true, .elements = 8},
    kClockOut{.name = "T",   .width = Width::Byte, .role = Role::Out,   .areas = kMemory,   .pointer = true, .elements = 8};

// --- strings and text: from the length byte, or the first character, on ---

inline constexpr OperandRule
    kInString   {.name = "IN",  .width = Width::Byte,                      .areas = kStringMemory, .constant = true, .pointer = true, .text = true,                 .most = kMostOfString},
    kOutString  {.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kStringMemory,                   .pointer = true, .text = true,                 .most = kMostOfString},
    kInOutString{.name = "OUT", .width = Width::Byte, .role = Role::InOut, .areas = kStringMemory,                   .pointer = true, .text = true,                 .most = kMostOfString},
    kOutString8 {.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kStringMemory,                   .pointer = true, .text = true, .elements = 9},
    kOutString12{.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kStringMemory,                   .pointer = true, .text = true, .elements = 13},
    kOutText    {.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kMemory,                         .pointer = true,               .elements = 3,  .most = 15},
    kOutText8   {.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kMemory,                         .pointer = true,               .elements = 8},
    kOutText12  {.name = "OUT", .width = Width::Byte, .role = Role::Out,   .areas = kMemory,                         .pointer = true,               .elements = 12};

inline constexpr OperandRule
    kIn1String = named("IN1", kInString), kIn2String = named("IN2", kInString);

// --- timers and counters ---

inline constexpr OperandRule
    kOffDelayTimer {.name = "T", .width = Width::Word, .role = Role::InOut, .areas = kTimers,  .timer = TimerKind::OffDelay},
    kOnDelayTimer  {.name = "T", .width = Width::Word, .role = Role::InOut, .areas = kTimers,  .timer = TimerKind::OnDelay},
    kRetentiveTimer{.name = "T", .width = Width::Word, .role = Role::InOut, .areas = kTimers,  .timer = TimerKind::Retentive},
    kCounter       {.name = "C", .width = Width::Word, .role = Role::InOut, .areas = kCounters};

// --- numbers that are part of the instruction; the CPU model says how many labels, subroutines, events … there are ---

inline constexpr OperandRule
    kLabel           {.name = "n",    .kind = OperandKind::Label},
    kSubroutineNumber{.name = "n",    .kind = OperandKind::Subroutine},
    kRoutineNumber   {.name = "n",    .kind = OperandKind::Interrupt},
    kRoutine         {.name = "INT",  .kind = OperandKind::Interrupt},
    kEvent           {.name = "EVNT", .kind = OperandKind::Event},
    kPort            {.name = "PORT", .kind = OperandKind::Port},
    kHighSpeedCounter{.name = "HSC",  .kind = OperandKind::Counter},
    kMode            {.name = "MODE", .kind = OperandKind::Number,    .max = 12},
    kStackLevel      {.name = "n",    .kind = OperandKind::StackLevel},
    kLoopNumber      {.name = "LOOP", .kind = OperandKind::Number,    .max = 7},
    kPulseOutput     {.name = "X",    .kind = OperandKind::Number,    .max = 1},
    kAnyNumber       {.name = "n",    .kind = OperandKind::Number,    .max = kLargestByte};

// clang-format on

}  // namespace s7200::operands
