// The rules that hold for every server of ours, one place for all of them: what `s7200 view`, `s7200 dap --listen` and the
// bridges keep, each as far as its protocol allows. tests/surroundings (servers) tries each rule with each server that the
// help lists.
//
// - It is closed until it is opened: without an address it serves this computer only. `dap` serves no other at all.
// - Any page that a browser shows can send requests to a port of this computer. So the first bytes must be the protocol's,
//   else the connection ends before anything is done, and that is said. Raw bytes, whose protocol nobody knows, may begin
//   with anything but a request of a browser.
// - A protocol with a place for it needs a token, which is printed where the server says where it listens. Until it was
//   right nothing is opened, written or run; a wrong one ends the connection, and that is said. The serial protocols of the
//   bridges have no such place.
// - A client may do what the command line allowed, no more: run the programs, write the files and open the ports of that.
// - Messages, their depth, the clients at a time and what waits for or from any of them are bounded. Where clients take
//   turns, the next one waits until the one before has gone.
// - A client that says nothing before it is let in, begins a message and does not go on, or does not read what it is sent,
//   has to go after kMostSilence.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace s7200::tools {

inline constexpr std::chrono::seconds kMostSilence{10};
inline constexpr int kMostWaitingClients = 16;  ///< of a server that serves one after the other

/// Whether a connection begins as that of a browser does: with a method of HTTP, a blank and the path that is wanted.
bool is_web_request(std::string_view first_bytes);

/// The text of the note on such a connection.
inline constexpr std::string_view kWebRequest = "it began with a request of HTTP, as a web page does";

/// A random token of 128 bits, in hex.
std::string new_token();

/// Compares tokens in a time that does not depend on where they differ.
bool is_same_token(std::string_view given, std::string_view token);

}  // namespace s7200::tools
