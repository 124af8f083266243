/// @file test_loaders.c
/// Structures from other programs' files: what is read, what becomes one, what is refused and where.
///
/// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "loaders/structure.h"
#include "support.h"

static structure_options options;

static structure loaded(structure_format format, const char *text) {
    structure made;
    scene_error error = {""};
    if (!structure_parse(format, text, strlen(text), "file", &options, &made, &error))
        fail_msg("refused: %s", error.text);
    return made;
}

static void check_refused(structure_format format, const char *text, const char *message) {
    structure made;
    scene_error error = {""};
    if (structure_parse(format, text, strlen(text), "file", &options, &made, &error))
        fail_msg("taken, not refused with \"%s\"", message);
    check_contains(error.text, message);
}

static int start(void **state) {
    (void)state;
    options = structure_options_default();
    return 0;
}

// The spring between two particles.
static const mspring_spring_def *spring_between(const structure *in, mspring_id a, mspring_id b) {
    for (uint32_t i = 0; i < in->spring_count; i++)
        if ((in->springs[i].a == a && in->springs[i].b == b) || (in->springs[i].a == b && in->springs[i].b == a))
            return &in->springs[i];
    fail_msg("no spring between %u and %u", a, b);
    return NULL;
}

/* ----------------------------------------------------------------------------------------------- Rigs of Rods */

#define CART_NODES                                                                                                 \
    "Cart\n"                                                                                                       \
    "globals\n120, 60, tracks/cart\n"                                                                              \
    "nodes\n0, 0, 0, 0\n1, 3, 0, 0\n2, 0, 0, 4\n3, 3, 0, 4\n4, 3, 4, 0, l\n"
#define CART CART_NODES "minimass\n1\nbeams\n0, 1\n2, 3\n0, 2\n0, 3\n1, 4\nend\n"

static void a_vehicle_is_seen_from_the_side(void **state) {
    (void)state;
    structure cart = loaded(STRUCTURE_RIGS_OF_RODS, CART);
    // In xy, 2 lies behind 0 and 3 behind 1. Beams: 0-1, 2-3 (merged with it), 0-2 (dropped), 0-3 (merged), 1-4.
    assert_int_equal(cart.report.nodes, 5);
    assert_int_equal(cart.report.merged_nodes, 2);
    assert_int_equal(cart.particle_count, 3);
    assert_int_equal(cart.report.beams, 5);
    assert_int_equal(cart.report.dropped_beams, 1);
    assert_int_equal(cart.report.merged_springs, 2);
    assert_int_equal(cart.spring_count, 2);
    assert_int_equal(cart.report.plane, STRUCTURE_PLANE_XY);
    // 0-1 and 2-3 lie in the plane; 0-3 is 5 m long and leans: (3 / 5)^2 of it counts. Rounding of floats alone.
    check_near(spring_between(&cart, 0, 1)->stiffness, 9e6 * (2 + 0.36), 2);
    check_near(spring_between(&cart, 0, 1)->damping, 12000 * (2 + 0.36), 0.01);
    check_near(spring_between(&cart, 0, 1)->rest_length, 3, 1e-6);
    check_near(spring_between(&cart, 1, 2)->stiffness, 9e6, 1);
    structure_free(&cart);
}

static void its_mass_lies_along_the_beams(void **state) {
    (void)state;
    structure cart = loaded(STRUCTURE_RIGS_OF_RODS, CART);
    // 120 kg on 3 + 3 + 4 + 5 + 4 = 19 m of beams, half of each on either end; the cargo of 60 kg on node 4.
    const double per_metre = 120.0 / 19 / 2;
    check_near(cart.report.mass, 180, 1e-9);
    check_near(cart.particles[0].mass, per_metre * (3 + 4 + 5 + 3 + 4), 1e-4);
    check_near(cart.particles[1].mass, per_metre * (3 + 4 + 3 + 5), 1e-4);
    check_near(cart.particles[2].mass, per_metre * 4 + 60, 1e-4);
    structure_free(&cart);
    // Without minimass no node has less than 50 kg.
    cart = loaded(STRUCTURE_RIGS_OF_RODS, CART_NODES "beams\n0, 1\n");
    check_near(cart.report.mass, 60 + 2 * 60 + 2 * 50, 1e-9);
    assert_int_equal(tally_of(&cart.report.notes, "nodes raised to the least mass"), 2);
    structure_free(&cart);
}

static void it_may_be_seen_in_other_planes(void **state) {
    (void)state;
    options.plane = STRUCTURE_PLANE_XZ;
    structure cart = loaded(STRUCTURE_RIGS_OF_RODS, CART);
    // From above, 4 lies on 1.
    assert_int_equal(cart.particle_count, 4);
    assert_int_equal(cart.report.dropped_beams, 1);
    assert_int_equal(cart.spring_count, 4);
    check_near(cart.particles[2].y, 4, 0);
    structure_free(&cart);
    options.plane = STRUCTURE_PLANE_YZ;
    cart = loaded(STRUCTURE_RIGS_OF_RODS, CART);
    // From the front, 0 and 1 coincide, and 2 and 3; 0-2 (4 m) and 0-3 (4 of 5 m) become one, 0-1 and 2-3 nothing.
    assert_int_equal(cart.particle_count, 3);
    assert_int_equal(cart.report.dropped_beams, 2);
    check_near(spring_between(&cart, 0, 1)->stiffness, 9e6 * (1 + 0.64), 2);
    structure_free(&cart);
}

static void nodes_merge_within_the_distance_given(void **state) {
    (void)state;
    const char *text = "x\nnodes\n0 0 0 0\n1 0.004 0.003 0\n2 0 1 0\nbeams\n0 2\n1 2\n";
    options.merge_distance = 0.0051;
    structure made = loaded(STRUCTURE_RIGS_OF_RODS, text);
    assert_int_equal(made.particle_count, 2);
    structure_free(&made);
    options.merge_distance = 0.0049;
    made = loaded(STRUCTURE_RIGS_OF_RODS, text);
    assert_int_equal(made.particle_count, 3);
    structure_free(&made);
}

static void defaults_hold_until_they_change(void **state) {
    (void)state;
    structure made =
        loaded(STRUCTURE_RIGS_OF_RODS, "x\nnodes\n0 0 0 0\n1 1 0 0\n2 2 0 0\n3 3 0 0\n4 4 0 0\n5 5 0 0\n"
                                       "beams\n0 1\n"
                                       "set_beam_defaults 1000, 20, -1, 500\n1 2\n"
                                       "set_beam_defaults_scale 2 3 1 4\n2 3\n"
                                       "set_beam_defaults -1, -1, -1, -1\n3 4\n"
                                       "shocks\n4 5 700 80 0.5 0.5 0.9 n\n");
    check_near(spring_between(&made, 0, 1)->stiffness, 9e6, 1);
    check_near(made.break_strain[0], 1e6 / 9e6, 1e-6); // force over stiffness, of 1 m
    check_near(spring_between(&made, 1, 2)->stiffness, 1000, 0);
    check_near(spring_between(&made, 1, 2)->damping, 20, 0);
    check_near(made.break_strain[1], 0.5, 1e-6);
    check_near(made.break_strain[4], 4 * 4e6 / 700, 0.1); // scaled by 4, and of a shock four times as much
    check_near(spring_between(&made, 2, 3)->stiffness, 2000, 0);
    check_near(spring_between(&made, 2, 3)->damping, 60, 0);
    check_near(made.break_strain[2], 1, 1e-6);
    check_near(spring_between(&made, 3, 4)->stiffness, 18e6, 1);
    check_near(spring_between(&made, 4, 5)->stiffness, 700, 0);
    check_near(spring_between(&made, 4, 5)->damping, 80, 0);
    check_near(spring_between(&made, 4, 5)->rest_length, 0.9, 1e-6);
    structure_free(&made);
}

static void words_may_be_separated_in_odd_ways(void **state) {
    (void)state;
    structure made = loaded(STRUCTURE_RIGS_OF_RODS,
                            "x\r\n;nothing\r\n//nor here\r\nNODES2\r\nleft,0|0 , 0,l 40\r\n"
                            "\tright : 2:0:0 ;last\r\n\r\nbeams\r\nleft,,right,i\r\nend\r\nbeams\r\nno no\r\n");
    assert_int_equal(made.particle_count, 2);
    assert_int_equal(made.spring_count, 1);
    check_near(made.particles[0].mass, 50, 0);
    structure_free(&made);
}

static void wheels_are_rings_that_stand_on_a_node(void **state) {
    (void)state;
    const char *text = CART_NODES "beams\n0 1\nwheels\n0.5, 1, 8, 0, 2, 9999, 1, 1, 1, 40, 1000, 10, a b\n";
    structure made = loaded(STRUCTURE_RIGS_OF_RODS, text);
    // 2 x 8 nodes, seen as a ring of 8; 9 beams to a ray.
    assert_int_equal(made.report.nodes, 5 + 16);
    assert_int_equal(made.report.beams, 1 + 8 * 9);
    assert_int_equal(made.particle_count, 3 + 8);
    double lowest = 0;
    for (uint32_t i = 3; i < made.particle_count; i++) {
        check_near(hypot(made.particles[i].x, made.particles[i].y), 0.5, 1e-6);
        check_near(made.particles[i].mass, 5, 1e-6);
        lowest = fmin(lowest, made.particles[i].y);
    }
    check_near(lowest, -0.5, 1e-9);
    structure_free(&made);
    options.wheels = false;
    made = loaded(STRUCTURE_RIGS_OF_RODS, text);
    assert_int_equal(made.report.nodes, 5);
    structure_free(&made);
}

static void what_is_not_read_is_counted(void **state) {
    (void)state;
    structure made =
        loaded(STRUCTURE_RIGS_OF_RODS, CART_NODES "fileinfo 1, 2\nengine\n1, 2, 3\nflares\n1, 2\n2, 3\n"
                                                  "comment\na\nb\nend_comment\nfixes\n3\n"
                                                  "beams\n0, 1, r\n"
                                                  "section -1 big\n1 4\nend_section\n"
                                                  "section -1 small\n0 4\nend_section\n");
    assert_int_equal(tally_of(&made.report.ignored, "engine"), 1);
    assert_int_equal(tally_of(&made.report.ignored, "flares"), 2);
    assert_int_equal(tally_of(&made.report.ignored, "fileinfo"), 1);
    assert_int_equal(tally_of(&made.report.ignored, "other variants"), 1);
    assert_int_equal(tally_of(&made.report.used, "nodes"), 5);
    assert_int_equal(made.report.pinned_particles, 1);
    assert_int_equal(made.spring_count, 2);
    structure_free(&made);
}

static void beams_bend_pull_and_push(void **state) {
    (void)state;
    structure made = loaded(STRUCTURE_RIGS_OF_RODS,
                            CART_NODES "set_beam_defaults 1e6, 100, 5e4, 2e5\nset_beam_defaults_scale 1, 1, 2, 1\n"
                                       "beams\n0, 1, r\n1, 4, s\n0, 4\n");
    assert_int_equal(made.spring_count, 3);
    assert_int_equal(made.springs[0].flags, MSPRING_SPRING_PULL_ONLY);
    assert_int_equal(made.springs[1].flags, MSPRING_SPRING_PUSH_ONLY);
    assert_int_equal(made.springs[2].flags, 0);
    // Twice 5e4 N is half of what breaks it.
    for (int i = 0; i < 3; i++)
        check_near((double)made.springs[i].yield_strain, 0.5 * (double)made.break_strain[i], 1e-6);
    structure_free(&made);
    // Beside another beam a rope becomes plain, and yields as both do; two ropes stay one.
    made = loaded(STRUCTURE_RIGS_OF_RODS, CART_NODES "set_beam_defaults 1e6, 100, 5e4, 2e5\n"
                                                     "beams\n0, 1, r\n0, 1\n0, 4, r\n0, 4, r\n");
    assert_int_equal(made.springs[0].flags, 0);
    assert_int_equal(made.springs[1].flags, MSPRING_SPRING_PULL_ONLY);
    assert_true(made.springs[0].yield_strain < MSPRING_NEVER);
    assert_int_equal(tally_of(&made.report.notes, "springs that only pull or push, taken as plain beside others"),
                     1);
    structure_free(&made);
    made =
        loaded(STRUCTURE_JBEAM, "{\"p\":{\"nodes\":[[\"id\",\"posX\",\"posY\",\"posZ\"],[\"a\",0,0,0],"
                                "[\"b\",0,2,0],[\"c\",0,0,2]],\"beams\":[[\"id1:\",\"id2:\"],{\"beamSpring\":1e6},"
                                "{\"beamDeform\":1e5},{\"beamType\":\"|SUPPORT\"},[\"a\",\"b\"],"
                                "{\"beamType\":\"|NORMAL\"},{\"beamDeform\":\"FLT_MAX\"},[\"b\",\"c\"]]}}");
    assert_int_equal(made.spring_count, 2);
    assert_int_equal(made.springs[0].flags, MSPRING_SPRING_PUSH_ONLY);
    check_near((double)made.springs[0].yield_strain, 1e5 / (1e6 * 2), 1e-7);
    assert_int_equal(made.springs[1].flags, 0);
    assert_true(made.springs[1].yield_strain >= MSPRING_NEVER);
    structure_free(&made);
}

static void broken_vehicles_are_refused_with_line_and_column(void **state) {
    (void)state;
    const structure_format format = STRUCTURE_RIGS_OF_RODS;
    check_refused(format, "", "file: nothing in it");
    check_refused(format, "x\n", "there is no node");
    check_refused(format, "x\nnodes\n0, 0, 0\n", "file:3:8: the line ends after 3 of 4: name x y z");
    check_refused(format, "x\nnodes\n0, 0, 1.2.3, 0\n", "file:3:7: '1.2.3' is no coordinate");
    check_refused(format, "x\nnodes\n0, nan, 0, 0\n", "file:3:4: 'nan' is no coordinate");
    check_refused(format, "x\nnodes\n0, 1e99, 0, 0\n", "file:3:4:");
    check_refused(format, "x\nnodes\n7, 0, 0, 0\n007, 1, 0, 0\n",
                  "file:4:1: there is a node '007' already, on line 3");
    check_refused(format, CART_NODES "beams\n0, 9\n", "file:11:4: there is no node '9'");
    check_refused(format, CART_NODES "beams\n0\n", "file:11:2: the line ends after 1 of 2");
    check_refused(format, CART_NODES "shocks\n0 1 5 5 0.5 0.5 0\n", "file:11:17: '0' is no tension");
    check_refused(format, CART_NODES "wheels\n0.5,1,99999,0,2,9,1,1,1,40,1,1\n",
                  "file:11:7: '99999' is no number of rays");
    check_refused(format, CART_NODES "wheels\n0.5,1,9,0,0,9,1,1,1,40,1,1\n", "in one place");
    check_refused(format, CART_NODES "comment\n", "the file ends before the end_comment of line 10");
    check_refused(format, "x\nglobals\n-5, 1\n", "file:3:1: '-5' is no dry mass");
}

/* ------------------------------------------------------------------------------------------------------- jbeam */

#define BOX_NODES                                                                                                  \
    "{\"box\": {\"nodes\": [[\"id\",\"posX\",\"posY\",\"posZ\"], {\"nodeWeight\":5}\n"                             \
    " [\"a\",0,0,0], [\"b\",1,1,0,{\"nodeWeight\":7}], {\"fixed\":true} [\"c\",0,1,1],],\n"

static void a_jbeam_is_read_however_loosely_written(void **state) {
    (void)state;
    structure box = loaded(
        STRUCTURE_JBEAM, "\xef\xbb\xbf// cases\n" BOX_NODES "/* three { beams */ \"beams\":[[\"id1:\",\"id2:\"],\n"
                         "{\"beamSpring\":2000,\"beamDamp\":30, \"beamStrength\":\"FLT_MAX\",},\n"
                         "[\"a\",\"b\"] [\"b\",\"c\",{\"beamSpring\":1e3,\"beamStrength\":500}],,\n"
                         "[\"a\",\"c\"] {\"beamPrecompression\":0.5}], \"triangles\":[[\"id1:\"],[1],[2]]},"
                         "\"another\":{}}");
    // The side is yz: a (0, 0), b (1, 0), c (1, 1).
    assert_int_equal(box.report.plane, STRUCTURE_PLANE_YZ);
    assert_int_equal(box.particle_count, 3);
    check_near(box.particles[0].mass, 5, 0);
    check_near(box.particles[1].mass, 7, 0);
    assert_int_equal(box.particles[2].flags, MSPRING_PARTICLE_PINNED);
    check_near(spring_between(&box, 0, 1)->stiffness, 2000 * 0.5, 1e-3); // 45 degrees out of the plane
    check_near(spring_between(&box, 0, 2)->stiffness, 2000, 1e-3);
    check_near(box.break_strain[0], 0, 0);
    check_near(spring_between(&box, 1, 2)->stiffness, 1000 * 0.5, 1e-3);
    check_near(spring_between(&box, 1, 2)->damping, 30 * 0.5, 1e-5);
    check_near(box.break_strain[1], 500 / (1000 * sqrt(2)) / 0.5, 1e-6);
    assert_int_equal(tally_of(&box.report.ignored, "triangles"), 2);
    assert_int_equal(tally_of(&box.report.ignored, "other parts"), 1);
    structure_free(&box);
}

static void variables_stand_for_their_defaults(void **state) {
    (void)state;
    const char *text = BOX_NODES "\"variables\":[[\"name\",\"default\"],[\"$k\",77]],"
                                 "\"beams\":[[\"id1:\",\"id2:\"],{\"beamSpring\":\"$k\"},[\"a\",\"c\"]]}}";
    structure box = loaded(STRUCTURE_JBEAM, text);
    check_near(spring_between(&box, 0, 2)->stiffness, 77, 1e-4);
    structure_free(&box);
}

static void broken_jbeams_are_refused_with_line_and_column(void **state) {
    (void)state;
    const structure_format format = STRUCTURE_JBEAM;
    check_refused(format, "", "file:1:1: the file must begin with a '{'");
    check_refused(format, "{\"a\":{}}", "no part of it has nodes");
    check_refused(format, BOX_NODES, "file:1:9: this '{' is never closed");
    check_refused(format, "{\n \"a\" {}}", "file:2:6: a colon belongs here");
    check_refused(format, "{\"a\":\"x\n\"}", "file:1:6: this string has no end");
    check_refused(format, "{ /* }", "file:1:3: this comment has no end");
    check_refused(format, "{\"a\":12x}", "file:1:6: '12x' is no value");
    check_refused(format, "{\"a\":#}", "file:1:6: '#' is no value");
    check_refused(format, "{} x", "file:1:4: there is something behind");
    check_refused(format, BOX_NODES "\"beams\":[[\"id1:\",\"id2:\"],[\"a\",\"x\"]]}}",
                  "file:3:32: 'x' is no node of this part");
    check_refused(format, BOX_NODES "\"beams\":[[\"id1:\"],[\"a\",\"b\"]]}}", "no column 'id2:'");
    check_refused(format, BOX_NODES "\"beams\":[[\"id1:\",\"id2:\"],{\"beamSpring\":\"$=1+2\"}]}}",
                  "'$=1+2' is a formula");
    check_refused(format, BOX_NODES "\"beams\":[[\"id1:\",\"id2:\"],{\"beamSpring\":-1}]}}",
                  "'-1' is no number that can stand here");
    check_refused(format, "{\"p\":{\"nodes\":[[\"id\",\"posX\",\"posY\",\"posZ\"],[\"a\",0,0]]}}",
                  "'a' has not got three coordinates");
    options.part = "lid";
    check_refused(format, BOX_NODES "}}", "there is no part 'lid'");
    char deep[300] = "{\"a\":";
    memset(deep + 5, '[', 200);
    check_refused(format, deep, "file:1:70: more than 64 brackets inside each other");
}

/* --------------------------------------------------------------------------------------------------------- OBJ */

static void lines_of_an_obj_become_springs(void **state) {
    (void)state;
    options.mass = 2;
    options.stiffness = 300;
    structure made = loaded(STRUCTURE_OBJ,
                            "# a corner\no corner\nv 0 0 0\nv 1 0 0\nv 1 1 0 # top\nl 1 2/5 3\nl -1 1\nf 1 2 3\n");
    assert_int_equal(made.particle_count, 3);
    assert_int_equal(made.spring_count, 3);
    check_near(made.particles[1].mass, 2, 0);
    check_near(spring_between(&made, 0, 2)->rest_length, sqrt(2), 1e-6);
    check_near(spring_between(&made, 0, 2)->stiffness, 300, 0);
    assert_int_equal(tally_of(&made.report.ignored, "f"), 1);
    structure_free(&made);
    check_refused(STRUCTURE_OBJ, "v 0 0 0\nl 1 2\n", "file:2:5: there is no vertex '2'");
    check_refused(STRUCTURE_OBJ, "v 0 0 0\nl 1 0\n", "file:2:5: there is no vertex '0'");
    check_refused(STRUCTURE_OBJ, "v 0 0\n", "file:1:6: the line ends before its coordinate");
    check_refused(STRUCTURE_OBJ, "v 0 0 0\nl 1\n", "file:2:4: the line ends after 2 of 3");
}

/* --------------------------------------------------------------------------------------------------- and then */

static void a_structure_becomes_a_scene_and_a_text_network(void **state) {
    (void)state;
    structure cart = loaded(STRUCTURE_RIGS_OF_RODS, CART);
    scene_error error = {""};
    scene built, read;
    assert_true(structure_scene(&cart, "folder/cart.truck", &built, &error));
    assert_string_equal(built.name, "cart");
    assert_int_equal(mspring_builder_count(built.builder, MSPRING_PARTICLES), 3);
    const char *path = "test_loaders.msn";
    assert_true(structure_write(&cart, path, &error));
    const scene_options from_file = scene_options_from_file();
    assert_true(scene_network_file(path, &from_file, &read, &error));
    assert_int_equal(remove(path), 0);
    mspring_network *first = NULL, *second = NULL;
    check_ok(mspring_network_create(built.builder, NULL, &first));
    check_ok(mspring_network_create(read.builder, NULL, &second));
    uint64_t hash = 0, other = 1;
    check_ok(mspring_network_step(first, 1e-3));
    check_ok(mspring_network_step(second, 1e-3));
    check_ok(mspring_network_get_state_hash(first, &hash));
    check_ok(mspring_network_get_state_hash(second, &other));
    assert_true(hash == other);
    mspring_network_destroy(first);
    mspring_network_destroy(second);
    scene_free(&built);
    scene_free(&read);
    structure_free(&cart);
}

static void files_are_told_by_their_endings(void **state) {
    (void)state;
    structure made;
    scene_error error = {""};
    assert_int_equal(structure_format_of("a/b.TRUCK"), STRUCTURE_RIGS_OF_RODS);
    assert_int_equal(structure_format_of("b.x.jbeam"), STRUCTURE_JBEAM);
    assert_int_equal(structure_format_of("b.obj"), STRUCTURE_OBJ);
    assert_int_equal(structure_format_of("truck"), STRUCTURE_UNKNOWN);
    assert_false(structure_load("b.txt", &options, &made, &error));
    check_contains(error.text, "does not tell what it is");
    assert_false(structure_load("not/there.truck", &options, &made, &error));
    check_contains(error.text, "cannot open");
    assert_false(structure_load("ship.png", &options, &made, &error));
    check_contains(error.text, "materials");
    options.merge_distance = 0;
    check_refused(STRUCTURE_OBJ, "v 0 0 0\n", "merge distance");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_vehicle_is_seen_from_the_side, start),
        cmocka_unit_test_setup(its_mass_lies_along_the_beams, start),
        cmocka_unit_test_setup(it_may_be_seen_in_other_planes, start),
        cmocka_unit_test_setup(nodes_merge_within_the_distance_given, start),
        cmocka_unit_test_setup(defaults_hold_until_they_change, start),
        cmocka_unit_test_setup(words_may_be_separated_in_odd_ways, start),
        cmocka_unit_test_setup(wheels_are_rings_that_stand_on_a_node, start),
        cmocka_unit_test_setup(what_is_not_read_is_counted, start),
        cmocka_unit_test_setup(broken_vehicles_are_refused_with_line_and_column, start),
        cmocka_unit_test_setup(a_jbeam_is_read_however_loosely_written, start),
        cmocka_unit_test_setup(variables_stand_for_their_defaults, start),
        cmocka_unit_test_setup(beams_bend_pull_and_push, start),
        cmocka_unit_test_setup(broken_jbeams_are_refused_with_line_and_column, start),
        cmocka_unit_test_setup(lines_of_an_obj_become_springs, start),
        cmocka_unit_test_setup(a_structure_becomes_a_scene_and_a_text_network, start),
        cmocka_unit_test_setup(files_are_told_by_their_endings, start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
