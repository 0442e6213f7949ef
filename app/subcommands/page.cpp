// cellmirror page: where the running gateway's monitor page is, with the token, for the person who started it.
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/subcommands/subcommand.hpp"
#include "config/command_line/command_line.hpp"
#include "ipc/control/instance.hpp"
#include "ipc/web/page_address.hpp"

namespace cellmirror::app {

namespace {

struct PageOptions {
  bool json = false;
  std::string instance{kDefaultInstance};
};

int print_page(const PageOptions& options) {
  const auto instance = find_instance(options.instance);
  if (!instance) return refuse(instance.error().text());
  const auto socket = control_socket_of(options.instance);
  if (!socket) return refuse(socket.error().text());
  const auto page = web::read_page_address(socket->parent_path());
  if (!page) return refuse(page.error().text());
  if (!options.json) {
    std::printf("%s\n", page->url_with_token().c_str());
    return kExitDone;
  }
  const nlohmann::json document = {{"address", page->url()},
                                   {"address_with_token", page->url_with_token()},
                                   {"token", page->token},
                                   {"read_only", page->read_only}};
  std::printf("%s\n", document.dump().c_str());
  return kExitDone;
}

}  // namespace

void add_page(cli::Command program, Action& action) {
  auto options = std::make_shared<PageOptions>();
  cli::Command sub = program.subcommand(
      "page", "Print the address of the running gateway's monitor page, with the token that lets it command");
  sub.flag("--json", options->json, "one JSON document");
  sub.option("--instance", options->instance, "name of the gateway").show_default();
  sub.footer("Example: xdg-open \"$(cellmirror page)\"\nWhoever has the token may command: keep it to yourself.");
  sub.when_named([options, &action] { action = [options] { return print_page(*options); }; });
}

}  // namespace cellmirror::app
