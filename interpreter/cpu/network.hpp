// NETR and NETW: a port in PPI master mode (SMB30, SMB130: mm = 2) reads from and writes to other stations (facts 10.9).
//
//   table   0 status   1 station   2 to 5 pointer to the data there: I, Q, M or V   6 how many bytes, 1 to 16   7 … these
//   status  bit 7 done, bit 6 active, bit 5 error, bits 0 to 3 which: NetworkError
//
// A port has eight jobs at most and does one after the other, each as an exchange of ppi.hpp from the master's side.
//
// Not documented, modelled so:
// - Requests are sent, and what has come is put into the table, in the communication part of the scan. What NETW sends is
//   read from the table then; station, pointer and length are those that the instruction has found.
//   [Network.TheTableChangesInTheCommunicationPartOfTheScan, Network.WhatIsAskedForStaysWhenTheTableChanges]
// - A station that does not answer within 150 ms is asked again when the line is silent, three times in all, and so is one
//   whose answer is damaged; the jobs behind it wait. [Network.AStationThatDoesNotAnswerIsAskedThreeTimes,
//   Network.ADamagedAnswerIsAReceiveError]
// - A station that accepts a request and has no answer yet is polled again at once, for kLongestWork, a second, which is
//   twice the longest scan that a watchdog allows; then the job ends with error 1.
//   [Network.ASlowStationIsPolledUntilItAnswers, Network.AStationThatNeverHasItsAnswerIsGivenUp]
// - Error 3, offline, does not occur: when it does, no document says. A station that is not there is error 1.
//   [Network.AStationThatDoesNotAnswerIsAskedThreeTimes]
// - A job that cannot begin is done with its error at once. A table that is on the list already stays as it is.
//   [Network.AJobThatCannotBeginSaysWhy, Network.ATableOnTheListIsNotListedAgain]
// - A port that leaves the master mode ends its jobs with error 5. [Network.LeavingTheMasterModeEndsTheJobs]
// - Jobs go on in STOP. [Network.JobsGoOnInStop]
// - A master that hears another one goes on as if it were alone: it asks 33 bits after what it heard last. They may collide.
//   [Network.AMasterThatHearsAnotherOneGoesOnAndTheTraceSaysSo]
// Not modelled: the token of several masters, the search for stations that are new.
#pragma once

#include <span>

#include "interpreter/cpu/core.hpp"

namespace s7200::network {

/// Whether a port is in PPI master mode.
bool is_master(const Core& core, std::uint8_t port);

/// The number of bytes that a table asks for; 0 if it reaches beyond its area.
std::uint8_t length_of(const Core& core, std::uint32_t table);

/// NETR, or NETW if it `writes`; `table` is a place in the image.
void start(Core& core, std::uint8_t port, std::uint32_t table, bool writes);

/// A frame that is none of a master's, for this station, or E5; a reply to it may begin at `at`.
void heard(Core& core, std::uint8_t port, std::span<const std::uint8_t> frame, Time at);

/// Tells the port that damaged characters came in.
void heard_damaged(Core& core, std::uint8_t port);

/// The program has written the port's control byte.
void follow_control(Core& core, std::uint8_t port);

/// The communication part of the scan.
void communicate(Core& core);

/// A time-out.
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::network
