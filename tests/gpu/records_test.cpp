// A kernel reads the records that the host packs, field by field, bit for bit.
#include "selftest/records.h"

#include "gpu/device_fixture.h"

namespace candela {
namespace {

using RecordsTest = DeviceTest;

TEST_F(RecordsTest, EveryFieldOfEveryRecordArrives) {
    expect_holds(test_records(device(), SceneAccess::texel_buffers));
    expect_holds(test_records(device(), SceneAccess::storage_buffers));
}

TEST_F(RecordsTest, OctahedralNormalsKeepTheirDirection) {
    expect_holds(test_octahedral_normals(device()));
}

}  // namespace
}  // namespace candela
