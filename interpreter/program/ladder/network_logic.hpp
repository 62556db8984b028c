// What the instructions of a network do, without a CPU: which outputs run, in which order, and each under which condition.
// Contacts are unknowns, boxes are opaque; two networks are the same if they run the same outputs under the same conditions
// for all values of their contacts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/stl/ast.hpp"

namespace s7200 {

struct NetworkLogic {
  /// A bit or a comparison, as it is at one point of the network.
  struct Contact {
    std::string name;
    bool normally_closed = false;               ///< where it is first used
    const stl::Statement* statement = nullptr;  ///< its first use, of an edge EU or ED; null: it comes from in front
    bool operator==(const Contact& other) const { return name == other.name; }
  };
  /// A gate of the circuit that the logic stack holds. Operands come before the gates that use them.
  struct Gate {
    enum class Kind : std::uint8_t { True, Contact, Not, And, Or } kind = Kind::True;
    std::size_t a = 0, b = 0;                   ///< indices of contacts or gates
    bool normally_closed = false;               ///< of a contact, as it is used here
    const stl::Statement* statement = nullptr;  ///< the same: of several that read the same bit this one
  };
  /// An output, or an edge, which remembers its input.
  struct Action {
    const stl::Statement* statement = nullptr;
    std::string text;                   ///< the same for all notations of its operands
    std::vector<std::size_t> inputs{};  ///< gates: its condition, or of a counter the levels of the stack
  };

  std::vector<Contact> contacts;
  std::vector<Gate> gates;
  std::vector<Action> actions;
};

/// The state of the logic stack between two networks, as far as it is known: whether its top is always 1.
struct StackBetween {
  bool on = false;
  std::vector<bool> loops{};  ///< the same at each FOR whose NEXT is still to come
};

NetworkLogic logic_of(std::span<const stl::Statement* const> statements, StackBetween& stack);

/// Whether a statement begins a network in a listing without NETWORK lines, after the statement before it.
bool begins_network(const stl::Statement& statement, const stl::Statement* before);

/// The difference between two networks.
struct LogicDifference {
  std::size_t action = 0;                               ///< the first that differs: index in both
  bool condition = false;                               ///< both have it, but under different conditions
  bool on_in_first = false;                             ///< with the values below
  std::vector<std::pair<std::string, bool>> example{};  ///< values of the contacts for which only one of them runs it
};

/// Tries all values of up to 12 contacts; of more, each contact against all others, and samples with a fixed seed.
std::optional<LogicDifference> difference(const NetworkLogic& first, const NetworkLogic& second);

/// Whether both have the same outputs with the same operands in the same order, whatever their conditions.
bool same_actions(const NetworkLogic& first, const NetworkLogic& second);

}  // namespace s7200
