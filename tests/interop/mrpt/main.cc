#include <cstdio>
#include <exception>

#include "stack.h"

int main() {
  try {
    mrpt_stack::Stack(patrol::link::StackClient::connect()).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mrpt_stack: %s\n", error.what());
    return 1;
  }
  return 0;
}
