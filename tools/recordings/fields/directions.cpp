// The words for requests and answers.
#include <algorithm>
#include <array>
#include <iterator>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/words.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// The words for a request in English, German, French, Spanish, Italian, Portuguese, Russian and Chinese; ASCII letters in
/// capitals.
constexpr std::array<std::string_view, 40> kRequestWords{"TX",
                                                         "SENT",
                                                         "SEND",
                                                         "WRITE",
                                                         "WRITTEN",
                                                         "REQUEST",
                                                         "QUERY",
                                                         "MASTER",
                                                         "GESENDET",
                                                         "SENDEN",
                                                         "ANFRAGE",
                                                         "SENDE",
                                                         "ENVOI",
                                                         "ENVOY\u00E9",
                                                         "ENVOYE",
                                                         "\u00E9MISSION",
                                                         "EMISSION",
                                                         "REQU\u00EATE",
                                                         "REQUETE",
                                                         "ENVIADO",
                                                         "ENVIAR",
                                                         "ENVIO",
                                                         "SOLICITUD",
                                                         "INVIATO",
                                                         "INVIO",
                                                         "RICHIESTA",
                                                         "PEDIDO",
                                                         "\u041F\u0435\u0440\u0435\u0434\u0430\u0447\u0430",
                                                         "\u0417\u0430\u043F\u0440\u043E\u0441",
                                                         "\u041E\u0442\u043F\u0440\u0430\u0432\u043B\u0435\u043D\u043E",
                                                         "\u53D1",
                                                         "\u53D1\u9001",
                                                         "\u53D1\u9001\u6570\u636E",
                                                         "OUTGOING",
                                                         "TXD",
                                                         "SND",
                                                         "XMIT",
                                                         "TRANSMIT",
                                                         "TRANSMITTED",
                                                         "SENDING"};
constexpr std::array<std::string_view, 39> kAnswerWords{"RX",
                                                        "RECV",
                                                        "RECEIVED",
                                                        "READ",
                                                        "RESPONSE",
                                                        "ANSWER",
                                                        "REPLY",
                                                        "SLAVE",
                                                        "EMPFANGEN",
                                                        "EMPFANG",
                                                        "ANTWORT",
                                                        "EMPFANGE",
                                                        "RE\u00E7U",
                                                        "RECU",
                                                        "R\u00E9CEPTION",
                                                        "RECEPTION",
                                                        "R\u00E9PONSE",
                                                        "REPONSE",
                                                        "RECIBIDO",
                                                        "RECIBIR",
                                                        "RESPUESTA",
                                                        "RICEVUTO",
                                                        "RICEZIONE",
                                                        "RISPOSTA",
                                                        "RECEBIDO",
                                                        "RESPOSTA",
                                                        "\u041F\u0440\u0438\u0435\u043C",
                                                        "\u041F\u0440\u0438\u0451\u043C",
                                                        "\u041E\u0442\u0432\u0435\u0442",
                                                        "\u041F\u043E\u043B\u0443\u0447\u0435\u043D\u043E",
                                                        "\u6536",
                                                        "\u63A5\u6536",
                                                        "\u63A5\u6536\u6570\u636E",
                                                        "INCOMING",
                                                        "RXD",
                                                        "RCV",
                                                        "RCVD",
                                                        "RECEIVE",
                                                        "RECEIVING"};
constexpr std::size_t kLongestDirection = 20;  // bytes of UTF-8

/// The text with blanks in place of signs that are not letters: U+2000 to U+2FFF and the wide ones from U+FF00 on.
std::string without_signs(std::string_view text) {
  std::string letters(text);
  for (std::size_t i = 0; i + 2 < letters.size(); ++i)
    if (letters[i] == '\xE2' || letters[i] == '\xEF') letters.replace(i, 3, 3, ' ');
  return letters;
}

/// A word with its ASCII letters in capitals and its Latin letters with accents small: U+00C0 to U+00DE in UTF-8.
std::string in_form_of_lists(std::string_view word) {
  std::string form = stl::upper_case(word);
  for (std::size_t i = 0; i + 1 < form.size(); ++i) {
    const auto second = static_cast<unsigned char>(form[i + 1]);
    if (form[i] == '\xC3' && second >= 0x80 && second <= 0x9E) form[i + 1] = static_cast<char>(second + ('a' - 'A'));
  }
  return form;
}

/// Whether a word names the station of a line, not its sender: `slave 1 TX`
bool is_station_with_number(std::string_view word, std::string_view after) {
  const std::size_t next = after.find_first_not_of(kAllBlanks);
  return (word == "SLAVE" || word == "MASTER") && next != 0 && next != std::string_view::npos && stl::is_digit(after[next]);
}

}  // namespace

Direction direction_of_brackets(std::string_view bytes) {
  if (bytes.starts_with('[')) return Direction::Request;
  if (bytes.starts_with('<')) return Direction::Answer;
  return Direction::Unknown;
}

Direction direction_of(std::string_view written) {
  const bool ascii = stl::is_ascii(written);
  const std::string letters = ascii ? "" : without_signs(written);
  const std::string_view text = ascii ? written : std::string_view(letters);
  constexpr std::size_t kShortest = 2;
  bool request = text.find('>') != std::string_view::npos || written.find("\u2192") != std::string_view::npos;
  bool answer = text.find('<') != std::string_view::npos || written.find("\u2190") != std::string_view::npos;
  for (std::size_t end = 0; end < text.size();) {
    const auto begin = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(end), text.end(), is_letter_of_any_language);
    const auto after = std::find_if_not(begin, text.end(), is_letter_of_any_language);
    end = static_cast<std::size_t>(after - text.begin());
    const auto length = static_cast<std::size_t>(after - begin);
    if (length < kShortest || length > kLongestDirection) continue;
    const std::string word = in_form_of_lists({begin, after});
    if (is_station_with_number(word, {after, text.end()})) continue;
    request = request || std::ranges::find(kRequestWords, word) != kRequestWords.end();
    answer = answer || std::ranges::find(kAnswerWords, word) != kAnswerWords.end();
  }
  if (request == answer) return Direction::Unknown;
  return request ? Direction::Request : Direction::Answer;
}

Direction direction_in_cell(std::string_view cell) {
  const std::string word = stl::upper_case(stl::trim(cell));
  return word == "OUT" ? Direction::Request : word == "IN" ? Direction::Answer : direction_of(cell);
}

Direction direction_beside_bytes(std::string_view text) {
  const auto is_other = [](char c) { return !is_word_sign(c); };
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_other).base();
  const auto begin = std::find_if(std::reverse_iterator(end), text.rend(), is_other).base();
  const std::string word = end - begin <= 3 ? stl::upper_case({begin, end}) : std::string();
  return word == "OUT" ? Direction::Request : word == "IN" ? Direction::Answer : Direction::Unknown;
}

}  // namespace s7200::tools
