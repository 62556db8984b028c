#include "tools/faces/page/server/serve.hpp"

#include <optional>
#include <utility>

#include "tools/faces/page/server/assets.hpp"
#include "tools/faces/page/server/inbox.hpp"
#include "tools/host/host_time.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/net/web_server.hpp"

namespace s7200::tools::page {
namespace {

void hand_over(Conversation& talk, const Incoming& incoming) {
  switch (incoming.kind) {
    case Incoming::Kind::Joined:
      talk.greet(incoming.client);
      break;
    case Incoming::Kind::Message:
      talk.handle(incoming.client, incoming.message, incoming.undone);
      break;
    case Incoming::Kind::Unreadable:
      talk.complain(incoming.client, incoming.message.get<std::string>());
      break;
    case Incoming::Kind::Left:
      talk.leave(incoming.client);
      break;
    case Incoming::Kind::Ended:
      break;
  }
}

}  // namespace

void serve(PageServer server, History& history, PageSettings settings, PageFlags& flags,
           const std::function<void(std::function<void(const std::string&)> say)>& when_saying) {
  Inbox inbox(flags.stop, flags.pause);
  const WebServer::Calls calls{.joined = [&](Client client) { inbox.join(client); },
                               .came = [&](Client client, const std::string& message) { return inbox.put(client, message); },
                               .left = [&](Client client) { inbox.leave(client); },
                               .said = server.note,
                               .now_and_then =
                                   [&] {
                                     if (interrupted()) inbox.end();
                                   }};
  WebServer web(std::move(server.listener), server.token, page_files(), calls);

  std::optional<Conversation> talk;
  settings.pause = &flags.pause;
  settings.clock = host_time;
  settings.live_run = [&](bool on) { inbox.run_is_live(on); };
  settings.carry_out = [&] {
    bool any = false;
    while (const auto incoming = inbox.take_waiting()) {
      hand_over(*talk, *incoming);
      any = true;
    }
    return any;
  };
  settings.session.stop_request = StopToken(flags.stop);
  settings.session.interruption = [] { return std::string(interrupted() ? interruption_text() : "stopped"); };
  talk.emplace(history, std::move(settings),
               Post{.to = [&](Client client, std::string message) { web.send(client, std::move(message)); },
                    .to_all = [&](std::string message) { web.send_to_all(std::move(message)); }});
  when_saying([&](const std::string& text) { talk->say(text + '\n'); });
  server.ready(web.address());

  for (Incoming incoming = inbox.take(); incoming.kind != Incoming::Kind::Ended && !talk->is_over();) {
    hand_over(*talk, incoming);
    if (!talk->is_over()) incoming = inbox.take();
  }
  talk->end(talk->is_over() ? "quit" : "the server ends");
  when_saying([](const std::string&) {});
}

}  // namespace s7200::tools::page
