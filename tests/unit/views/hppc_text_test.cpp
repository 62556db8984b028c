#include "tools/views/hppc_text.hpp"

#include <gtest/gtest.h>

#include "interpreter/base/bytes.hpp"

namespace s7200::tools {
namespace {

TEST(HppcText, EachBitOfAStatusHasItsWords) {
  EXPECT_EQ(hppc_status_text(0), "status 16#00");
  EXPECT_EQ(hppc_status_text(0x12), "status 16#12: network not found, processor not running");
  EXPECT_EQ(hppc_status_text(0x1F),
            "status 16#1F: special function data valid, network not found, controlled by an MCR, controlled by a skip, "
            "processor not running");
}

TEST(HppcText, AParameterTableIsSaidWithItsPlaceAndWhatIsKnownOfIt) {
  EXPECT_EQ(hppc_parameters_text(Bytes{0, 0, 8}), "parameter table at 16#80000");
  EXPECT_EQ(hppc_parameters_text(Bytes{0, 0, 8, 0x8A, 0}), "parameter table at 16#80000: 8a 00");
  Bytes whole{0, 0, 8};
  whole.resize(3 + 0x34);
  whole[3 + 0x2E] = 0xFE, whole[3 + 0x2F] = 0xBF, whole[3 + 0x30] = 0x0A;
  EXPECT_TRUE(hppc_parameters_text(whole).starts_with("parameter table at 16#80000, holding register 1 at 16#ABFFE: 00"));
}

}  // namespace
}  // namespace s7200::tools
