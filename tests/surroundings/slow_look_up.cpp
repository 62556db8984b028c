// A host name that no name server knows anything of, as a program with this library in LD_PRELOAD meets it: the look-up
// goes on for an hour.
#include <netdb.h>
#include <unistd.h>

#include <cstdio>

extern "C" int getaddrinfo(const char* /*node*/, const char* /*service*/, const addrinfo* /*hints*/, addrinfo** /*found*/) {
  std::fputs("looking up\n", stderr);
  for (int second = 0; second < 3600; ++second) sleep(1);
  return EAI_AGAIN;
}
