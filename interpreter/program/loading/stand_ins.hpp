// Stand-ins for the routines of Micro/WIN's own libraries, which are in no export and in no listing: subroutines of our own
// with the same names, parameters, results and error codes, from stl_programs/libraries.
//
// A program that calls a routine of such a library and has none of that name gets the library's stand-in: its blocks with
// free numbers of routines and labels, its variables in V memory. Its names are its own: they collide with none of the
// program's.
//
// Not documented, modelled so:
// - The variables of a library are where the program's symbol Modbus_Slave_Memory, Modbus_Master_Memory or one of these with
//   _P1 says, otherwise in the highest free bytes of V memory. An address that the program names is not free, nor are the 256
//   bytes from a pointer's target on, nor the holding registers of MBUS_INIT.
//   [StandIns.TakeTheHighestFreeBytesOfVMemory, StandIns.TakeTheMemoryThatTheProgramGivesThem,
//   StandIns.LeaveTheHoldingRegistersAlone]
// - MBUS_INIT with an error leaves the slave off; MBUS_SLAVE is then Done with Error 10. [StandIns.MbusInitTellsWhatIsWrong]
// - MBUS_SLAVE is Done with Error 6 after a disturbed character from any station, and with Error 7 after a wrong CRC of a frame
//   to it or to all. [LibrarySlave.IsDoneWithError6AfterADisturbedCharacterFromAnyStation,
//   LibrarySlave.IsDoneWithError7AfterAWrongCrcOfAFrameToItOrToAll]
// - Exceptions 1, 2 and 3 are the Errors 8, 9 and 4 of MBUS_SLAVE; more than 120 registers are exception 3.
//   [LibrarySlave.TellsExceptions1And2And3AsErrors8And9And4, LibrarySlave.Serves120RegistersAtMost]
// - MBUS_SLAVE is Done after a broadcast that writes, and ignores one that reads.
//   [LibrarySlave.IsDoneAfterABroadcastThatWritesAndIgnoresOneThatReads]
// - Mode of MBUS_CTRL is a BOOL; MBUS_CTRL sets the port up in the first scan and when a parameter changes, and does all of the
//   work after MBUS_MSG has sent the request. [LibraryMasterPort.IsSetUpInTheFirstScanAndWhenParametersChange]
// - The time-out runs from the end of the request to the first character of the answer.
//   [LibraryMaster.WaitsFromTheEndOfTheRequestForTheFirstCharacterOfTheAnswer]
// - A request is sent again after the errors 1, 3, 7 and 8, but not after an exception.
//   [LibraryMaster.AsksAgainTwiceWithoutAnAnswer, LibraryMaster.DoesNotAskAgainAfterAnException]
// - A broadcast is Done after 100 ms. [LibraryMaster.IsDone100MillisecondsAfterABroadcast]
// - MBUS_MSG is Error 6 if its parameters are not those of the request that is being done. [StandIns.MbusMsgOneAtATime]
// - MBUS_CTRL and MBUS_MSG leave the accumulators as they were, as MBUS_SLAVE does by the manual of the S7-200 SMART.
//   [StandIns.TheAccumulatorsOfTheCallerKeepTheirValues]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// The blocks of the stand-ins that a program needs, to be added to it when its own names are resolved.
using StandInFiles = std::vector<stl::ParseResult>;

/// Finds the calls of routines that have a stand-in, and lets them call it. The names of `program` are not resolved yet. The
/// diagnostics of `program` say if there is no room for one.
StandInFiles link_stand_ins(stl::ParseResult& program, const CpuModel& model);

/// Whether a program calls a routine that may need a stand-in, so that its lines are different for each CPU.
bool may_need_stand_ins(const stl::ParseResult& program);

/// Whether a CALL is of such a routine.
bool has_stand_in(const stl::Statement& call);

/// Whether a name is that of a routine of one of Siemens' libraries for Micro/WIN, with or without a stand-in: `USS_INIT`.
bool is_library_routine(std::string_view name);

/// The message about a CALL of a name that stands for no routine of the program.
struct MissingRoutine {
  std::string message, hint, cause;
};
MissingRoutine missing_routine(const stl::Name& name, const CpuModel& model);

/// A stand-in that a checked program has.
struct StandIn {
  std::string file;                   ///< as messages name it: `stand-in:modbus_slave.awl`
  std::vector<std::string> routines;  ///< of the library, that the program calls
  std::uint32_t memory = 0;           ///< first byte of its variables in V memory
  std::uint32_t bytes = 0;            ///< how many there are
  stl::Position call{};               ///< the first
};
std::vector<StandIn> stand_ins_of(const stl::Source& program);

/// Whether a file of a program is a stand-in: it is no file on the disk, but part of the command.
bool is_stand_in(std::string_view file);

/// The number of such a file, from 1 on; nothing for another file.
std::optional<std::size_t> number_of_stand_in(std::string_view file);

/// The text of the file with a number; empty if there is none.
std::string stand_in_text(std::size_t number);

/// `MBUS_INIT and MBUS_SLAVE are in no export: …`
std::string to_text(const StandIn& stand_in);

/// The same message as an error, where stand-ins are not wanted.
stl::Diagnostic refusal(const StandIn& stand_in);

}  // namespace s7200
