#pragma once
// What OpenMesh::IO::read_mesh does not know itself: point formats, and a property of .om files.

namespace hsdm {

/// Makes OpenMesh::IO::read_mesh read .xyz, .xyzn, .xyzrgb, .asc, .txt, .csv, .pcd, .pts, .ptx and .pwn as
/// vertices without faces: positions and, if asked for by the options, normals in double precision, colours
/// too; and `hsdm_normals` of .om files, a property of a type that OpenMesh does not know: without this call
/// it says so on standard error and leaves the property out, unless the mesh has it before. It returns false
/// where hsdm::read_points throws; call that for the reason. To be called once, before the first such read
/// and not at the same time as one (OpenMesh's list of readers is not locked); more calls do nothing. An
/// object that registers itself would be dropped by the linker, as the library is a static one.
void register_readers();

} // namespace hsdm
