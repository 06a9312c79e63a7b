# What is built from what: explicit lists, in the order in which data flows. No globs: a stray file is found by the test
# `house_rules`, which also reads this file on its own.

# Folder triangle/, the sequential mesher. C11 only.
set(PTRIANGLE_MESHER_SOURCES
    triangle/status.c
    triangle/scratch_file.c
    triangle/predicates.c
    triangle/pslg.c
    triangle/mesh.c
    triangle/radix.c
    triangle/hilbert.c
    triangle/spatial.c
    triangle/insertion.c
    triangle/curve_sort.c
    triangle/delaunay.c
    triangle/crossing.c
    triangle/recover.c
    triangle/flip_history.c
    triangle/flip.c
    triangle/overlap.c
    triangle/bundle.c
    triangle/constrain.c
    triangle/sweep_line.c
    triangle/locate.c
    triangle/carve.c
    triangle/why_empty.c
    triangle/chain.c
    triangle/reconstruct.c
    triangle/cavity.c
    triangle/hidden_wall.c
    triangle/interpolate.c
    triangle/degrees.c
    triangle/quality.c
    triangle/size_text.c
    triangle/small_angle.c
    triangle/groundwork.c
    triangle/feature_size.c
    triangle/split.c
    triangle/disk.c
    triangle/bad_queue.c
    triangle/criterion.c
    triangle/inside.c
    triangle/credit.c
    triangle/entry_set.c
    triangle/refine.c
    triangle/pause.c
    triangle/census.c
    triangle/crowd.c
    triangle/estimate.c
    triangle/stats.c
    triangle/generate.c
    triangle/api/figure.c
    triangle/api/mesh.c
    triangle/api/arrays.c
    triangle/dropin/switches.c
    triangle/topology.c
    triangle/grid.c
    triangle/dropin/input.c
    triangle/dropin/output.c
    triangle/dropin/run.c
    triangle/dropin/aloud.c
    triangle/dropin/triangulate.c)

# Folder triangle/check/, the judge of meshes, and its public door. Of the mesher it knows the predicates alone.
set(PTRIANGLE_CHECK_SOURCES
    triangle/check/check.c
    triangle/check/survey.c
    triangle/check/part.c
    triangle/check/triangles.c
    triangle/check/edges.c
    triangle/check/pairs.c
    triangle/check/store.c
    triangle/check/match.c
    triangle/check/segments.c
    triangle/check/stars.c
    triangle/check/order.c
    triangle/check/missing.c
    triangle/check/overlap.c
    triangle/check/hull.c
    triangle/check/tube.c
    triangle/check/chain.c
    triangle/check/border.c
    triangle/check/vertex_markers.c
    triangle/check/input.c
    triangle/check/nodes.c
    triangle/check/attributes.c
    triangle/check/apex.c
    triangle/check/quality.c
    triangle/api/judge.c)

# Folder triangle/, text files. The one C++ file wraps std::from_chars and std::to_chars.
set(PTRIANGLE_TEXT_SOURCES
    triangle/text/decimal.cpp
    triangle/text/names.c
    triangle/text/text.c
    triangle/text/window.c
    triangle/text/read.c
    triangle/text/output.c
    triangle/text/parts.c
    triangle/text/joined.c
    triangle/text/behind.c
    triangle/text/write.c
    triangle/text/layouts.c
    triangle/text/stream.c
    triangle/text/tile_store.c
    triangle/text/grouping.c
    triangle/text/boundary.c
    triangle/text/vtu.c
    triangle/text/gmsh.c
    triangle/text/hydro.c
    triangle/text/bytes.c
    triangle/text/tags.c
    triangle/text/read_vtu.c
    triangle/text/read_gmsh.c
    triangle/text/read_hydro.c
    triangle/text/formats.c
    triangle/api/files.c)

# Folder triangle/, HDF5 files, for the programs alone. Without the library of that name the second list stands in.
set(PTRIANGLE_HDF5_SOURCES
    triangle/hdf5/file.c
    triangle/hdf5/items.c
    triangle/hdf5/rows.c
    triangle/hdf5/array.c
    triangle/hdf5/segments.c
    triangle/hdf5/ends.c
    triangle/hdf5/views.c
    triangle/hdf5/xdmf.c
    triangle/hdf5/write.c
    triangle/hdf5/part.c
    triangle/hdf5/read.c)
set(PTRIANGLE_NO_HDF5_SOURCES triangle/hdf5/none.c triangle/hdf5/rows.c triangle/hdf5/part.c)

# What text and judge need of the mesher: all that their shared libraries have of it.
set(PTRIANGLE_TEXT_NEEDS triangle/status.c triangle/scratch_file.c triangle/pslg.c triangle/api/figure.c)
set(PTRIANGLE_CHECK_NEEDS triangle/status.c triangle/scratch_file.c triangle/pslg.c triangle/api/figure.c
    triangle/predicates.c)

# Folder sched/, the parallel schedule: compiled with OpenMP, as are the programs ptriangle and trianglecheck, which
# hand out threads (sched/threads.h), and nothing else.
set(PTRIANGLE_SCHED_SOURCES
    sched/theory.c
    sched/threads.c
    sched/by_tile.c
    sched/partition.c
    sched/room.c
    sched/sweep/tile_copy.c
    sched/sweep/finds.c
    sched/sweep/pipeline.c
    sched/sweep/tile_fill.c
    sched/sweep/tiles.c
    sched/sweep/stream.c
    sched/sweep/queue.c
    sched/sweep/deal.c
    sched/sweep/sort_triangles.c
    sched/sweep/move_triangles.c
    sched/sweep/numbering.c
    sched/sweep/park.c
    sched/sweep/spool.c
    sched/sweep/checkpoint.c
    sched/sweep/carry_halt.c
    sched/sweep/state.c
    sched/sweep/ahead.c
    sched/sweep/remain.c
    sched/sweep/sweep.c
    sched/worklist.c
    sched/halt.c
    sched/phase.c
    sched/ranks/carrier.c
    sched/ranks/borrow.c
    sched/ranks/hand_out.c
    sched/ranks/keep.c
    sched/ranks/lend.c
    sched/ranks/paste.c
    sched/ranks/pieces.c
    sched/ranks/ranks.c
    sched/ranks/relay.c
    sched/ranks/stream.c
    sched/ranks/talk.c
    sched/ranks/territory.c
    sched/schedule.c
    sched/triangulate.c
    sched/mesh.c)

# The ranks of an MPI, where there is one: a library of its own.
set(PTRIANGLE_MPI_SOURCES sched/ranks/mpi.c)
set(PTRIANGLE_MPI_HEADER include/ptriangle/mpi.h)

# Headers that are installed, below include/ptriangle/, beside triangle.h, which lies where Triangle's clients look for
# it.
set(PTRIANGLE_PUBLIC_HEADERS
    include/ptriangle/tri.h
    include/ptriangle/par.h
    include/ptriangle/tiles.h
    include/ptriangle/files.h
    include/ptriangle/check.h)

# Folder drivers/: the executables, each from drivers/<name>.c. The second list of programs needs the folder sched/ and
# its library.
set(PTRIANGLE_SEQUENTIAL_PROGRAMS triangle)
set(PTRIANGLE_JUDGE_SOURCES drivers/verdict.c sched/threads.c)
set(PTRIANGLE_JUDGED_SOURCES # reading of meshes that are there, for the judge and for meshplot
    drivers/resources.c
    drivers/scratch.c
    drivers/judged_text.c
    drivers/judged_h5.c
    drivers/judged_files.c
    drivers/judged_words.c
    drivers/one_line.c)
set(PTRIANGLE_EXAMPLES checkerboard) # need the library alone, are not installed
set(PTRIANGLE_PETSC_EXAMPLES poisson) # likewise, where PETSc is found
set(PTRIANGLE_PARALLEL_PROGRAMS ptriangle)

# meshplot, built where cairo is found.
set(PTRIANGLE_PLOT_SOURCES
    drivers/interrupt.c
    drivers/plot_part.c
    drivers/plot_density.c
    drivers/plot_colour.c
    drivers/plot_shade.c
    drivers/plot_field.c
    drivers/plot_draw.c)

# The command line of Triangle, for the mesh generators among the programs.
set(PTRIANGLE_RUN_SOURCES
    drivers/arguments.c
    drivers/console.c
    drivers/one_line.c
    drivers/help.c
    drivers/interrupt.c
    drivers/export.c
    drivers/mesh_files.c
    drivers/summary.c
    drivers/self_check.c
    drivers/resources.c
    drivers/estimate.c
    drivers/disk_needs.c
    drivers/plan.c
    drivers/run.c)
set(PTRIANGLE_RUN_PROGRAMS triangle ptriangle)

# What the parallel program has beside that. Its report is written with jansson; without, the last file stands in.
set(PTRIANGLE_PARALLEL_SOURCES
    drivers/blocks_file.c
    drivers/joint_files.c
    drivers/launch.c
    drivers/long_options.c
    drivers/progress.c
    drivers/rank_report.c
    drivers/shared_input.c
    drivers/streams.c
    drivers/restart.c
    drivers/prediction.c
    drivers/replay.c)
set(PTRIANGLE_REPORT_SOURCE drivers/report_json.c)
set(PTRIANGLE_NO_REPORT_SOURCE drivers/report_none.c)

# As one of several tasks it is a rank of an MPI, or refuses.
set(PTRIANGLE_LAUNCH_SOURCE drivers/launch_mpi.c)
set(PTRIANGLE_NO_LAUNCH_SOURCE drivers/launch_alone.c)
