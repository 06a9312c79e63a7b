# Explicit lists of sources, in the order in which data flows. There are no globs: the test `house_rules`, which also
# reads this file, finds files that are in no list.

# The interface to the system (triangle/base/system.h): the parts for libraries, and further parts for programs.
set(PTRIANGLE_SYSTEM_SOURCES triangle/base/system.c triangle/base/system_posix.c)
set(PTRIANGLE_SYSTEM_PROCESS_SOURCES triangle/base/system_posix_process.c)
if(WIN32)
    set(PTRIANGLE_SYSTEM_SOURCES triangle/base/system.c triangle/base/system_windows.c
        triangle/base/system_windows_threads.c)
    set(PTRIANGLE_SYSTEM_PROCESS_SOURCES triangle/base/system_windows_process.c)
endif()

# Folder triangle/, the sequential mesher. C11 only.
set(PTRIANGLE_MESHER_SOURCES
    triangle/base/status.c
    triangle/base/order.c
    ${PTRIANGLE_SYSTEM_SOURCES}
    triangle/geometry/predicates.c
    triangle/mesh/pslg.c
    triangle/mesh/mesh.c
    triangle/base/radix.c
    triangle/geometry/hilbert.c
    triangle/cdt/spatial.c
    triangle/cdt/insertion.c
    triangle/cdt/delaunay.c
    triangle/cdt/crossing.c
    triangle/cdt/recover.c
    triangle/cdt/flip.c
    triangle/cdt/bundle.c
    triangle/cdt/constrain.c
    triangle/mesh/locate.c
    triangle/mesh/parents.c
    triangle/cdt/carve.c
    triangle/cdt/why_empty.c
    triangle/cdt/chain.c
    triangle/cdt/reconstruct.c
    triangle/mesh/cavity.c
    triangle/mesh/surface.c
    triangle/refine/place.c
    triangle/refine/front.c
    triangle/refine/petal.c
    triangle/base/size_text.c
    triangle/size/feature_size.c
    triangle/refine/split.c
    triangle/refine/bad_queue.c
    triangle/refine/lattice.c
    triangle/refine/sites.c
    triangle/refine/lattice_fill.c
    triangle/refine/feed.c
    triangle/refine/treat.c
    triangle/refine/star.c
    triangle/refine/degrees.c
    triangle/refine/smooth.c
    triangle/refine/refine.c
    triangle/refine/census.c
    triangle/size/crowd.c
    triangle/size/gap.c
    triangle/size/hopeless.c
    triangle/size/candidates.c
    triangle/size/near.c
    triangle/size/raster.c
    triangle/size/spread.c
    triangle/size/sampled.c
    triangle/size/background.c
    triangle/size/figure_sizes.c
    triangle/size/lengths.c
    triangle/size/quality.c
    triangle/size/estimate.c
    triangle/api/generate.c
    triangle/api/simplify.c
    triangle/api/region_polygons.c
    triangle/api/figure.c
    triangle/api/figure_mesh.c
    triangle/api/arrays.c
    triangle/dropin/switches.c
    triangle/mesh/topology.c
    triangle/mesh/grid.c
    triangle/dropin/io.c
    triangle/dropin/call.c
    triangle/dropin/aloud.c
    triangle/dropin/triangulate.c)

# Folder triangle/check/, the checker of meshes, and its public interface. Of the mesher it uses only the predicates.
set(PTRIANGLE_CHECK_SOURCES
    triangle/check/check.c
    triangle/check/survey.c
    triangle/check/shares.c
    triangle/check/edges.c
    triangle/check/pairs.c
    triangle/check/store.c
    triangle/check/subsegments.c
    triangle/check/missing.c
    triangle/check/winding.c
    triangle/check/segment_chains.c
    triangle/check/border.c
    triangle/check/vertices.c
    triangle/check/kept_input.c
    triangle/check/nodes.c
    triangle/check/bounds.c
    triangle/api/judge.c)

# Folder triangle/, text files. The one C++ file wraps std::from_chars and std::to_chars.
set(PTRIANGLE_TEXT_SOURCES
    triangle/text/decimal.cpp
    triangle/text/names.c
    triangle/text/text.c
    triangle/text/read.c
    triangle/text/output.c
    triangle/text/parts.c
    triangle/text/write.c
    triangle/text/layouts.c
    triangle/text/stream.c
    triangle/text/boundary.c
    triangle/text/vtu.c
    triangle/text/gmsh.c
    triangle/text/hydro.c
    triangle/text/reading.c
    triangle/text/read_vtu.c
    triangle/text/read_gmsh.c
    triangle/text/read_hydro.c
    triangle/text/formats.c
    triangle/text/words.c
    triangle/text/read_raster.c
    triangle/text/read_jigsaw.c
    triangle/text/read_view.c
    triangle/text/size_file.c
    triangle/api/files.c)

# Folder triangle/, HDF5 files, for the programs only. Without the HDF5 library the second list replaces the first.
set(PTRIANGLE_HDF5_SOURCES
    triangle/hdf5/file.c
    triangle/hdf5/rows.c
    triangle/hdf5/array.c
    triangle/hdf5/ends.c
    triangle/hdf5/views.c
    triangle/hdf5/h5_write.c
    triangle/hdf5/h5_read.c)
set(PTRIANGLE_NO_HDF5_SOURCES triangle/hdf5/none.c triangle/hdf5/rows.c)

# Sources of the mesher that text and checker need. Their shared libraries contain no others.
set(PTRIANGLE_TEXT_NEEDS triangle/base/status.c ${PTRIANGLE_SYSTEM_SOURCES} triangle/mesh/pslg.c triangle/api/figure.c)
set(PTRIANGLE_CHECK_NEEDS triangle/base/status.c triangle/base/order.c ${PTRIANGLE_SYSTEM_SOURCES}
    triangle/mesh/pslg.c triangle/api/figure.c
    triangle/geometry/predicates.c)

# Folder sched/, the parallel schedule. It is compiled with OpenMP if available, like the programs ptriangle and
# trianglecheck. No other code is.
set(PTRIANGLE_SCHED_SOURCES
    sched/schedule/threads.c
    sched/schedule/team.c
    sched/schedule/deal.c
    sched/schedule/partition.c
    sched/schedule/room.c
    sched/tiles/tile_arrays.c
    sched/tiles/finds.c
    sched/tiles/pipeline.c
    sched/tiles/tiles.c
    sched/tiles/tile_stream.c
    sched/tiles/queue.c
    sched/tiles/numbering.c
    sched/tiles/park.c
    sched/checkpoint/spool.c
    sched/checkpoint/checkpoint.c
    sched/checkpoint/state.c
    sched/tiles/sweep.c
    sched/schedule/worklist.c
    sched/schedule/phase.c
    sched/schedule/collect.c
    sched/ranks/carrier.c
    sched/ranks/borders.c
    sched/ranks/keep.c
    sched/ranks/hand_out.c
    sched/ranks/paste.c
    sched/ranks/ranks.c
    sched/ranks/relay.c
    sched/ranks/talk.c
    sched/ranks/wire.c
    sched/ranks/territory.c
    sched/schedule/prerefine.c
    sched/schedule/smoothing.c
    sched/schedule/schedule.c
    sched/schedule/par_triangulate.c
    sched/schedule/library.c)

# The ranks of an MPI: a separate library, built if there is an MPI.
set(PTRIANGLE_MPI_SOURCES sched/ranks/mpi.c)
set(PTRIANGLE_MPI_HEADER include/ptriangle/mpi.h)

# Headers that are installed below include/ptriangle/. triangle.h is installed where clients of Triangle expect it.
set(PTRIANGLE_PUBLIC_HEADERS
    include/ptriangle/tri.h
    include/ptriangle/par.h
    include/ptriangle/tiles.h
    include/ptriangle/files.h
    include/ptriangle/check.h)

# Folder drivers/: the executables, each from PTRIANGLE_MAIN_<name>. The second list of programs needs the folder sched/
# and its library.
set(PTRIANGLE_MAIN_triangle drivers/mesh/triangle.c)
set(PTRIANGLE_MAIN_ptriangle drivers/mesh/ptriangle.c)
set(PTRIANGLE_MAIN_trianglecheck drivers/judge/trianglecheck.c)
set(PTRIANGLE_MAIN_meshplot drivers/plot/meshplot.c)
set(PTRIANGLE_SEQUENTIAL_PROGRAMS triangle)
set(PTRIANGLE_JUDGE_SOURCES sched/schedule/threads.c sched/schedule/team.c drivers/mesh/size_options.c
    drivers/judge/judged_sizes.c)
set(PTRIANGLE_JUDGED_SOURCES # reading of meshes that are there, for the judge and for meshplot
    ${PTRIANGLE_SYSTEM_PROCESS_SOURCES}
    drivers/words.c
    drivers/judge/judged_text.c
    drivers/judge/judged_files.c)
set(PTRIANGLE_EXAMPLES checkerboard) # need the library alone, are not installed
set(PTRIANGLE_PETSC_EXAMPLES poisson) # likewise, where PETSc is found
set(PTRIANGLE_PARALLEL_PROGRAMS ptriangle)
set(PTRIANGLE_GEOJSON_SOURCE drivers/mesh/geojson.c) # for triangle, ptriangle and trianglecheck
set(PTRIANGLE_NO_GEOJSON_SOURCE drivers/mesh/geojson_none.c) # without jansson

# meshplot, built if cairo is found.
set(PTRIANGLE_PLOT_SOURCES
    drivers/interrupt.c
    drivers/plot/plot_part.c
    drivers/plot/plot_density.c
    drivers/plot/plot_shade.c
    drivers/plot/plot_field.c
    drivers/plot/plot_draw.c)

# The command line of Triangle, for triangle and ptriangle.
set(PTRIANGLE_RUN_SOURCES
    drivers/mesh/arguments.c
    drivers/mesh/console.c
    drivers/words.c
    ${PTRIANGLE_SYSTEM_PROCESS_SOURCES}
    drivers/interrupt.c
    drivers/mesh/mesh_files.c
    drivers/mesh/summary.c
    drivers/mesh/needs.c
    drivers/mesh/plan.c
    drivers/mesh/size_options.c
    drivers/mesh/stages.c)
set(PTRIANGLE_RUN_PROGRAMS triangle ptriangle)

# Further sources of ptriangle. Without jansson the last file replaces the one that writes the report.
set(PTRIANGLE_PARALLEL_SOURCES
    drivers/mesh/joint_files.c
    drivers/mesh/launch.c
    drivers/mesh/long_options.c
    drivers/mesh/orphans.c
    drivers/mesh/progress.c
    drivers/mesh/schedule_needs.c
    drivers/mesh/streams.c
    drivers/mesh/restart.c)
set(PTRIANGLE_REPORT_SOURCE drivers/mesh/report_json.c)
set(PTRIANGLE_NO_REPORT_SOURCE drivers/mesh/report_none.c)

# As one of several tasks it is a rank of an MPI. Without MPI it reports an error.
set(PTRIANGLE_LAUNCH_SOURCE drivers/mesh/launch_mpi.c)
set(PTRIANGLE_NO_LAUNCH_SOURCE drivers/mesh/launch_alone.c)
