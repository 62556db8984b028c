// Links of chains: contacts that stand one after the other and the coils that end them, in one go, with one look at the
// time. There is one for each way to join up to four contacts, made from the same combine() that single contacts use.
#include <array>
#include <utility>

#include "interpreter/instructions/bit_logic.hpp"
#include "interpreter/instructions/linked.hpp"

namespace s7200::linked {

/// A chain's link; for `joins` see link_of_chain().
template <std::size_t contacts, std::size_t joins>
inline void join(const Contact* contact, const std::uint8_t* image, LogicStack& stack) {
  if constexpr (contacts > 0) {
    const bool value = (image[contact->at] & contact->mask) != 0;
    bodies::combine<static_cast<Join>(joins % kJoins)>(stack, value != contact->inverted);
    join<contacts - 1, joins / kJoins>(contact + 1, image, stack);
  }
}

template <std::size_t contacts, std::size_t joins, std::size_t coils>
void chain(Core& core, const Op* op, Time left, std::uint64_t bits, std::uint64_t executed) {
  if (left <= op->chain_cost) return leave(core, op, left, bits, executed);
  const Contact* const first = core.contacts() + op->target;
  LogicStack stack = LogicStack::from_bits(bits);
  join<contacts, joins>(first, core.s.image.data(), stack);
  for (const Contact* coil = first + contacts; coil != first + contacts + coils; ++coil)
    core.put_mask(coil->at, coil->mask, stack.top());
  const Op* const next = op + contacts + coils;
  S7200_TAIL_CALL next->link(core, next, left - op->chain_cost, stack.bits(), executed + contacts + coils);
}

constexpr std::size_t ways_to_join(std::size_t contacts) { return contacts == 0 ? 1 : kJoins * ways_to_join(contacts - 1); }

// Choose the chain with the given numbers as template arguments, one number at a time.

template <std::size_t contacts, std::size_t coils, std::size_t... joins>
Link chain_of_joins(std::size_t wanted, std::index_sequence<joins...>) {
  static constexpr std::array<Link, sizeof...(joins)> kChains{chain<contacts, joins, coils>...};
  return kChains[wanted];
}

template <std::size_t coils, std::size_t... contacts>
Link chain_of_contacts(std::size_t wanted, std::size_t joins, std::index_sequence<contacts...>) {
  Link found = nullptr;
  ((contacts == wanted &&
    (found = chain_of_joins<contacts, coils>(joins, std::make_index_sequence<ways_to_join(contacts)>{}))) ||
   ...);
  return found;
}

template <std::size_t... coils>
Link chain_of_coils(std::size_t wanted, std::size_t contacts, std::size_t joins, std::index_sequence<coils...>) {
  Link found = nullptr;
  ((coils == wanted && (found = chain_of_contacts<coils>(contacts, joins, std::make_index_sequence<kMostContacts + 1>{}))) ||
   ...);
  return found;
}

}  // namespace s7200::linked

namespace s7200 {

Link link_of_chain(std::size_t contacts, std::size_t joins, std::size_t coils) {
  return linked::chain_of_coils(coils, contacts, joins, std::make_index_sequence<kMostCoils + 1>{});
}

}  // namespace s7200
