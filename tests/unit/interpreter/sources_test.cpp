// Where the value comes from that an instruction puts somewhere.
#include "interpreter/analysis/effects/sources.hpp"

#include "interpreter/analysis/effects/memory_names.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::sources_test {
namespace {

/// Of a box behind LD SM0.0, and V memory bit or bits at a byte.
std::string source(const std::string& box, std::uint32_t byte, std::uint8_t bit, std::uint64_t count = 1,
                   std::uint8_t in_vb9 = 0) {
  const auto program = program_of("LD SM0.0\n" + box + "\nMEND\n", *find_cpu("224"));
  std::vector<std::uint8_t> image(image::kConstants);
  image[image::kV + 9] = in_vb9;
  const auto found = source_of(*program, 1, {(std::uint64_t{image::kV} + byte) * 8 + bit, count}, image);
  if (!found) return "nothing";
  if (const auto constant = constant_bit(*program, *found)) return *constant ? "1" : "0";
  return memory_text(as_named(*found));
}

TEST(Sources, MovesAndConversionsHaveTheSameBitsOfTheirInput) {
  EXPECT_EQ(source("MOVB MB4, VB0", 0, 3), "M4.3");
  EXPECT_EQ(source("MOVW MW4, VW0", 1, 3), "M5.3");
  EXPECT_EQ(source("MOVD MD4, VD0", 0, 0, 32), "MD4");
  EXPECT_EQ(source("MOVR MD4, VD0", 3, 7), "M7.7");
  EXPECT_EQ(source("BMW MW4, VW0, 3", 5, 1), "M9.1");
  EXPECT_EQ(source("BTI MB4, VW0", 1, 2), "M4.2");
  EXPECT_EQ(source("BTI MB4, VW0", 0, 2), "nothing") << "filled up";
  EXPECT_EQ(source("ITB MW4, VB0", 0, 2), "M5.2");
  EXPECT_EQ(source("ITD MW4, VD0", 0, 0, 32), "MW4");
  EXPECT_EQ(source("+I MW4, VW0", 0, 2), "nothing") << "computed from two";
}

TEST(Sources, MayBeConstants) {
  EXPECT_EQ(source("MOVB 8, VB0", 0, 3), "1");
  EXPECT_EQ(source("MOVW 8, VW0", 0, 3), "0");
}

TEST(Sources, OfSHRBAreItsDataBitAndTheNeighbours) {
  EXPECT_EQ(source("SHRB I0.4, V0.6, 4", 0, 6), "I0.4");
  EXPECT_EQ(source("SHRB I0.4, V0.6, 4", 0, 7), "V0.6");
  EXPECT_EQ(source("SHRB I0.4, V0.6, 4", 1, 0), "V0.7") << "over the end of a byte";
  EXPECT_EQ(source("SHRB I0.4, V0.6, -4", 1, 1), "I0.4");
  EXPECT_EQ(source("SHRB I0.4, V0.6, -4", 0, 7), "V1.0");
  EXPECT_EQ(source("SHRB I0.4, V0.6, 4", 1, 2), "nothing") << "behind its end";
  EXPECT_EQ(source("SHRB I0.4, V0.6, VB9", 1, 1, 1, 0xFC), "I0.4") << "-4 in VB9";
  EXPECT_EQ(source("SHRB I0.4, V0.6, VB9", 0, 6), "nothing") << "0 bits are error 0092";
}

}  // namespace
}  // namespace s7200::test::sources_test
