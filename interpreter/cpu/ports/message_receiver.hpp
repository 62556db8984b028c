// RCV, the receive message service of the ports: SMB86–94 and SMB186–194, events 23 and 24 (facts 2.4 and 10.3).
//
//   off --RCV--> search for the start --first character--> message --an end--> off
//
//   SMB87   .7 enabled  .6 start character  .5 end character  .4 idle line  .3 the time is that of the message, otherwise
//           that between two characters  .2 end when the time has passed  .1 break, not on the CPUs 215 and 216
//   SMB86   .7 ended by the user  .6 bad parameters  .5 end character  .2 time  .1 count  .0 bad character
//   SMB88, 89 start and end character   SMW90 idle time   SMW92 time   SMB94 most characters
//
// The start condition is idle line, then start character; or break, then start character; each also alone. Another character
// than the start character makes it look for the idle line or the break again. All parameters are taken over when RCV is
// executed. Each character of a message is looked at in this order: error, store, end character, count. What the manuals
// leave open has a field in ReceiveChoices, named in brackets below.
//
// Not documented, modelled so:
// - The times end at ticks of the CPU's millisecond clock: the first one at which they have passed, so a time of 0 ends at
//   the next tick. [Receive.TimesEndAtTheFirstTickOfTheClockAtWhichTheyHavePassed]
// - Idle time and time between characters run from the end of a character to the end of the next: the receiver knows whole
//   characters only. [Receive.TheIdleTimeRunsToTheEndOfACharacter]
// - If idle line and break are both asked for, either is enough, whichever comes first (idle_or_break).
//   [Receive.IdleLineOrBreakWhicheverComesFirst]
// - An idle time of 0 with a start character asks for that character alone; without one, any character starts the message,
//   and its time runs from RCV. [Receive.EachStartConditionTakesItsFirstCharacter,
//   Receive.OnlyWithAnyCharacterTheTimeOfTheMessageEndsItWithoutOne]
// - RCV with SM87.7 = 0 while nothing is received only sets the status. [Receive.RcvThatIsNotEnabledSetsOnlyItsStatus]
// - What a refused XMT or RCV has found running goes on. [Receive.XmtAndRcvExcludeEachOtherInAllFourPairs]
// - A start character that is also the end character does not end the message (start_may_end).
//   [Receive.TheStartCharacterIsNotTheEnd]
// - The character that ends the message with an error is not stored (stores_bad_character).
//   [Receive.ABadCharacterEndsTheMessageAndIsNotStored]
// - An error counts once the start condition is met: where a start character is asked for, a bad one is dropped. A break
//   before the message is always dropped. [Receive.ABadCharacterIsNotAStartCharacter,
//   Receive.ABreakBeforeTheMessageIsDropped]
// - End character and count reached together set both bits (end_and_count).
//   [Receive.EndCharacterAndCountTogetherSetBothBits]
// - There is no event after RCV with SM87.7 = 0 (event_after_user_end) and none after bad parameters
//   (event_after_bad_parameters). [Receive.TheUserEndsItWithoutEvent,
//   Receive.WithoutAStartConditionOrRoomItIsRefusedInTheStatus]
// - Event 8 or 25 is not raised while RCV receives (character_events).
//   [Receive.TheCharacterEventIsNotRaisedWhileItReceives]
// - STOP and leaving Freeport mode end RCV silently: the status stays 0. [Receive.StopEndsItSilently,
//   Receive.LeavingFreeportModeEndsItSilently]
// - The number in the first byte of the table grows with each character. [Receive.TheNumberInTheTableGrows]
// Not modelled: overrun errors. The receiver takes every character.
#pragma once

#include "interpreter/cpu/core.hpp"

namespace s7200::message_receiver {

/// RCV: `table` is the place of the number of characters, which follow it. The port's error `busy` if it is sending, already
/// receiving (and this RCV does not end that) or not in Freeport mode; 0091 if the most characters do not fit in the area.
void receive(Core& core, std::uint8_t port, std::uint32_t table);

/// Whether the characters of a port belong to a message.
bool active(const Core& core, std::uint8_t port);

/// The line has brought a character to a port that is active.
void take(Core& core, std::uint8_t port, const ReceivedCharacter& character);

/// The port has left Freeport mode.
void abandon(Core& core, std::uint8_t port);

// For the table of units.
void enter_stop(Core& core);
void handle(Core& core, std::uint8_t what, Time at);

}  // namespace s7200::message_receiver
