#include <gtest/gtest.h>

#include <cstdio>

#include "own_network.hpp"

int main(int argc, char** argv) {
  if (!cellmirror::dds::test::enter_own_network()) {
    std::printf("no network namespace of our own on this machine: using its loopback\n");
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
