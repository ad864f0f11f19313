// What follows an image: opened with it, kept to the image it was made for, and refused when any byte of it is wrong.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "rt_core/certificate.h"
#include "tests/support/tiny_image.h"

namespace palpate::test {
namespace {

// A file of the tiny image and a certificate of two places and a tick.
class CertifiedFile {
 public:
  CertifiedFile() : image_(tiny_image()) {
    const CheckedPlace place{{0.01, 0.02, 0.03}, 8e-3, 2e-3, 1.5, 1.45, 0.04};
    const TickCertificate tick{{1, 2, 3, 4, 5, 6, 7}, 28, 1000, 4096, 8192, 4096};
    places_[0] = places_[1] = place;
    tick_ = tick;
    write();
  }
  void write() {
    const std::span<const std::byte> image = image_.bytes();
    CertificateHeader header{kCertificateMagic, 40 + 2 * 64 + 96, image_.header().checksum, 0, 2, 1};
    std::byte body[2 * 64 + 96];
    std::memcpy(body, places_, sizeof places_);
    std::memcpy(body + sizeof places_, &tick_, sizeof tick_);
    header.checksum = bytes_checksum(body);
    size_ = image.size() + header.total_bytes;
    block_.resize(size_ / kImageAlignment + 1);
    std::memcpy(at(), image.data(), image.size());
    std::memcpy(at() + image.size(), &header, sizeof header);
    std::memcpy(at() + image.size() + sizeof header, body, sizeof body);
  }
  std::byte* at() { return reinterpret_cast<std::byte*>(block_.data()); }
  std::span<const std::byte> bytes() { return {at(), size_}; }
  std::size_t image_bytes() { return image_.bytes().size(); }
  ImageResult open() {
    Model model;
    return open_image(bytes(), model);
  }

  CheckedPlace places_[2];
  TickCertificate tick_;

 private:
  struct alignas(kImageAlignment) Block {
    std::byte bytes[kImageAlignment];
  };
  ImageBytes image_;
  std::vector<Block> block_;
  std::size_t size_ = 0;
};

TEST(Certificate, FollowsItsImage) {
  CertifiedFile file;
  ASSERT_EQ(file.open().error, ImageError::kNone) << file.open().field;
  const Certificate certificate = certificate_of(file.bytes());
  ASSERT_EQ(certificate.place.size(), 2u);
  EXPECT_EQ(certificate.place[1].worst_error, 0.04);
  ASSERT_NE(certificate.tick, nullptr);
  EXPECT_EQ(certificate.tick->tick_instructions, 28);
  // The image is the same scene with it and without.
  Model with, without;
  ASSERT_EQ(open_image(file.bytes(), with).error, ImageError::kNone);
  ASSERT_EQ(open_image(file.bytes().first(file.image_bytes()), without).error, ImageError::kNone);
  EXPECT_EQ(with.scene_hash, without.scene_hash);
  EXPECT_TRUE(certificate_of(file.bytes().first(file.image_bytes())).place.empty());
}

TEST(Certificate, EveryWrongByteAndEveryCutIsRefused) {
  CertifiedFile file;
  for (std::size_t i = file.image_bytes(); i < file.bytes().size(); ++i) {
    file.at()[i] ^= std::byte{0x10};
    EXPECT_NE(file.open().error, ImageError::kNone) << i;
    file.at()[i] ^= std::byte{0x10};
    Model model;
    const bool none = i == file.image_bytes();  // cut there it is the image alone
    EXPECT_EQ(open_image(file.bytes().first(i), model).error == ImageError::kNone, none) << i;
  }
  EXPECT_EQ(file.open().error, ImageError::kNone);
}

TEST(Certificate, NumbersThatCannotBeTrueAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](auto spoil) {
    CertifiedFile file;
    spoil(file);
    file.write();
    return std::string(file.open().field);
  };
  EXPECT_EQ(refused([](CertifiedFile& f) { f.places_[1].worst_error = -1; }), "certificate.place");
  EXPECT_EQ(refused([](CertifiedFile& f) { f.places_[0].force_N = kNan; }), "certificate.place");
  EXPECT_EQ(refused([](CertifiedFile& f) { f.places_[0].place_m.y = kNan; }), "certificate.place");
  EXPECT_EQ(refused([](CertifiedFile& f) { f.tick_.ticks = -1; }), "certificate.tick");
  EXPECT_EQ(refused([](CertifiedFile& f) { f.tick_.stage_instructions[3] = kNan; }), "certificate.tick");
}

TEST(Certificate, OfAnotherImageIsRefused) {
  CertifiedFile file;
  ASSERT_EQ(file.open().error, ImageError::kNone);
  Certificate certificate;
  EXPECT_STREQ(open_certificate(file.bytes().subspan(file.image_bytes()), 1, certificate).field,
               "certificate.image_checksum");
}

}  // namespace
}  // namespace palpate::test
