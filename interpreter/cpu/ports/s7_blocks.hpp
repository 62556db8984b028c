// The blocks of a CPU, as S7 clients list and upload them. An S7-200 has three (S7-200 system manual, "Program Structure"):
// the program block OB1 with the main program, all subroutines and all interrupt routines, the data block DB1, and the
// system block SDB0.
//
// Not documented, modelled so:
// - DB1 is V memory as it stands, as when it is read and written: that is its length, and that is what an upload brings,
// each
//   part as it is when it is fetched. Around it are the head and the foot of a block of other S7 CPUs (snap7); times, author
//   and check sum in them are 0. [S7Blocks.TheInformationOfDb1HasTheLengthOfVMemory, S7Blocks.Db1IsUploadedInParts]
// - The languages of the three are STL, DB and SDB. [S7Blocks.TheBlocksOfATypeAreListed]
// - Of OB1 and SDB0 nothing is told but that they exist: there is no compiled program here, and how a system block is coded
//   is not known. They are refused with error D2 41, as by a CPU whose password protects them.
//   [S7Blocks.TheProgramAndTheSystemBlockAreProtected]
// - A port uploads one block at a time, whoever asks; a new start ends the upload before. Parts and ends without a start are
//   refused with error D2 40. [S7Blocks.AnUploadBeginsAnewWithEachStart, S7Blocks.PartsWithoutAStartAreRefused]
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "interpreter/cpu/core.hpp"
#include "interpreter/model/s7_pdu.hpp"

namespace s7200::s7_blocks {

/// Why the block cannot be told of; None if it can.
s7::Refusal refusal_of(const s7::BlockName& name);

/// The block list: `30`, type and number of blocks, for each type.
Bytes counts();

/// Number, flags and language of each block of the type; nothing if S7 has no such type.
std::optional<Bytes> of_type(std::uint8_t type);

/// The block information that S7 gives about DB1.
Bytes information(const CpuModel& model);

/// Bytes of DB1 as it is uploaded.
std::size_t upload_length(const CpuModel& model);

/// The part of DB1 from `first` on, of `most` bytes at most.
Bytes upload(const Core& core, std::size_t first, std::size_t most);

}  // namespace s7200::s7_blocks
