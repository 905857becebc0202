// Ids of Cryptomatte. The values are those of the specification's authors' own plug-ins.
#include "image/cryptomatte.h"

#include <cmath>

#include <gtest/gtest.h>

namespace candela {
namespace {

TEST(Cryptomatte, IdsAreHashes) {
    EXPECT_EQ(crypto_id("hello"), 0x248BFA47u);
    EXPECT_EQ(crypto_id("cube"), 0xD9682F08u);
}

// The hash of `part251` would be a denormal number, that of `part554` a NaN.
TEST(Cryptomatte, IdsAreFloatsThatEveryProgramKeeps) {
    EXPECT_EQ(murmur3_32("part251"), 0x0026BB1Du);
    EXPECT_EQ(crypto_id("part251"), 0x00A6BB1Du);
    EXPECT_EQ(murmur3_32("part554"), 0x7FD6861Eu);
    EXPECT_EQ(crypto_id("part554"), 0x7F56861Eu);
    EXPECT_EQ(crypto_id(""), 0x00800000u);
    for (const char* name : {"part251", "part554", ""})
        EXPECT_TRUE(std::isnormal(crypto_value(crypto_id(name))));
}

TEST(Cryptomatte, ChannelsAndAttributesHaveTheNamesOfTheSpecification) {
    EXPECT_EQ(crypto_channel(CRYPTO_OBJECT, 0, false), "CryptoObject00.R");
    EXPECT_EQ(crypto_channel(CRYPTO_OBJECT, 0, true), "CryptoObject00.G");
    EXPECT_EQ(crypto_channel(CRYPTO_MATERIAL, 5, false), "CryptoMaterial02.B");
    EXPECT_EQ(crypto_channel(CRYPTO_MATERIAL, 5, true), "CryptoMaterial02.A");
    EXPECT_TRUE(is_crypto_channel("CryptoMaterial02.A"));
    EXPECT_FALSE(is_crypto_channel("CryptoMaterial03.R"));
    EXPECT_FALSE(is_crypto_channel("CryptoObject.R"));
    EXPECT_EQ(crypto_attribute(CRYPTO_OBJECT, "name"), "cryptomatte/3ae39a5/name");
    EXPECT_EQ(crypto_attribute(CRYPTO_MATERIAL, "manifest"), "cryptomatte/be359d6/manifest");
}

}  // namespace
}  // namespace candela
