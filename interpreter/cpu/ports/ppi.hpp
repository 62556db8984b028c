// PPI, the protocol of a port that is not in Freeport mode: the CPU is a slave in RUN and in STOP (facts
// 2.1, 10.9). 8E1, at the rate and the station of the system block (program/loading/system_block.hpp) until SPA sets another
// station.
//
//   master                                  slave
//   SD2 with a request, function 6C         E5: accepted
//   SD1 that polls, function 5C             E5: there is no answer yet; or the answer, SD2 with function 08
//   SD1 that polls, function 7C, then 5C …  until the answer has come
//
// The frames are in base/ppi_frame.hpp, what a request asks for is in s7_services.hpp. It is carried out in the
// communication part of the scan, so a long program keeps its master waiting.
//
// Not documented, modelled so:
// - A reply begins 11 bit times after the last character. [Ppi.ARepliesBeginElevenBitTimesAfterTheRequest]
// - Silence of 33 bit times ends whatever was being received; after a wrong character nothing is understood until then.
//   [Ppi.AfterABadCharacterNothingIsUnderstoodUntilThereIsSilence]
// - A frame with a wrong check sum, length or end, or for another station, is ignored.
//   [Ppi.WhatIsNoFrameOrForAnotherStationIsIgnored]
// - A port works at one request at a time: until its answer has been fetched, other masters that ask or poll are told that
//   there is no resource (SD1, function 02). A poll by a master that has asked nothing is accepted with E5
//   otherwise. [Ppi.AnotherMasterIsToldThatThereIsNoResource]
// - A master that has neither asked nor polled for 450 ms, three tries of 150 ms (facts 10.9), has given up: another one is
//   served, and its answer is dropped. [Ppi.AMasterThatHasGivenUpIsNoLongerWaitedFor]
// - A request of the same master before it has fetched the answer to the one before takes its place: function 6C has the bit
//   of the frame count (20) without the one that makes it valid (10), as the first frame of a sequence in Profibus, and the
//   client library libnodave repeats a request whose E5 it has not heard. A published driver of the S7-200 (S7_200_PCPPI)
//   names SD1 with function 02 as the other thing that its master gets: so it is with SecondRequest::Refused, until the
//   answer has been fetched or the master has been silent for 450 ms.
//   [Ppi.ASecondRequestTakesThePlaceOfTheFirst, Ppi.ASecondRequestIsRefusedWhereThatIsChosen]
// - A poll that repeats the frame count bit of the one before gets the same answer again.
// [Ppi.ARepeatedPollGetsTheAnswerAgain]
// - The status of the station (function 49) is asked and answered with SD1, function 00, by a port in master mode too: it
//   waits for no token. [Ppi.TheStatusIsThatOfASlave, Network.TheMasterAnswersOtherMastersAsASlave]
// - What a request carries that is none of the S7 services gets no answer: polls are accepted with E5, and the trace says
//   so. [Ppi.WhatIsNoS7RequestGetsNoAnswerAndIsNamedInTheTrace]
// - A token, a broadcast and a frame with a longer address are ignored, and the trace says so.
//   [Ppi.WhatIsNotModelledIsIgnoredAndNamedInTheTrace]
// - RUN and STOP take effect when their answer has left, in the next communication part of the scan, so a master gets it
//   whatever the program then does with the port. Nobody has to fetch it: then the mode stays.
//   [Ppi.RunAndStopTakeEffectWhenTheirAnswerHasLeft, Ppi.AMasterThatDoesNotFetchTheAnswerToStopDoesNotStopTheCpu]
// - A port that goes to Freeport mode forgets what it was asked. A character that is leaving, or an E5 that is due, still
//   leaves, in the format of PPI; then the port listens in Freeport mode.
//   [Ppi.AnAcceptanceThatIsDueLeavesBeforeFreeportBegins]
// - XMT begins when the last character of a PPI answer has left. [Ppi.XmtWaitsForTheCharacterThatIsLeaving]
// Not modelled: the token of several masters, broadcasts, longer addresses. A CPU as master is in network.hpp.
#pragma once

#include <span>

#include "interpreter/cpu/core.hpp"

namespace s7200::ppi {

/// A master has given up after so long without a word.
inline constexpr Time kPatienceOfMasters = 450 * kMillisecond;

/// A port that speaks PPI at the usual rate is set so.
inline constexpr SerialFormat kFormat{
    .baud = SystemBlock{}.ppi_rates[0], .data_bits = 8, .parity = Parity::Even, .stop_bits = 1};

/// The same format at the rate of this port.
SerialFormat format_of(const Program& program, std::uint8_t port);

/// A reply begins so long after the last character; silence ends what was being received.
inline constexpr int kBitsToReply = 11, kBitsOfSilence = 33;

/// The port begins to speak PPI, at `at`.
void begin(Core& core, std::uint8_t port, Time at);

/// The port stops speaking PPI and forgets what it was asked. A character that is leaving still leaves.
void end(Core& core, std::uint8_t port);

/// Sends a frame from `at` on; the receiver is off meanwhile.
void send(Core& core, std::uint8_t port, std::span<const std::uint8_t> frame, Time at);

/// Reports of the line, for a port that speaks it.
void character_received(Core& core, std::uint8_t port, const ReceivedCharacter& character);
void character_sent(Core& core, std::uint8_t port, Time at);

/// The communication part of the scan, for a port that waits for it. The CPU may change to RUN or STOP. A port that the CPU
/// does not have never waits.
inline bool waits(const PpiPort& port) { return port.job == PpiPort::Job::Waiting || port.wanted_mode.has_value(); }
void communicate(Core& core, std::uint8_t port);

}  // namespace s7200::ppi
