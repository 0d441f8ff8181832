#!/bin/sh
# Tests of parameter studies as a user runs them: equal results for any number of processes, in parts, and after a kill; failed runs;
# messages. Run from the top of the checkout; ends with the line "N passed, N failed".
. tests/program_checks.sh
subcommand=sweep

study() { cat >"$work/$1.nml"; }   # study NAME: a study file from standard input

cp cases/sim_I.nml "$work/base.nml"
sed -i "s/'adams', revolutions = 4.0, relative_tolerance = 1.0e-6/'auto', revolutions = 3.0, relative_tolerance = 1.0e-4/" \
  "$work/base.nml"

# a grid, and its rows against single cases
study grid <<'END'
&study case = 'base.nml', cycles = T, strobe_columns = 'crank_angle, eccentricity_x', strobe_angle_deg = 90 /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 4, scale = 'log' /
&parameter key = 'initial.crank_speed', values = 100, 200, 3e2 /
END
run sweep -j 1 -o "$work/one" "$work/grid.nml"
check "a grid is run, status $status" [ "$status" = 0 -a "$(wc -l <"$work/out")" = 1 -a ! -s "$work/err" ]
check "a row for each run" [ "$(wc -l <"$work/one/grid.runs.csv")" = 13 ]
check "the last parameter varies fastest" [ "$(awk -F, 'NR == 3 { print $2, $3 }' "$work/one/grid.runs.csv")" = "1.000000000E-05 200" ]
check "every row has every column" [ "$(awk -F, '{print NF}' "$work/one/grid.runs.csv" | sort -u)" = 20 ]
check "number of strobes" [ "$(grep -c '^7,' "$work/one/grid.strobe.csv")" = "$(awk -F, '$1 == 7 { print $20 }' "$work/one/grid.runs.csv")" ]
check "number of revolutions" [ "$(grep -c '^7,' "$work/one/grid.cycles.csv")" = "$(awk -F, '$1 == 7 { print $5 }' "$work/one/grid.runs.csv")" ]
check "no file under a temporary name" [ -z "$(find "$work/one" -name '*.part')" ]
run -o "$work/single" -s joint.clearance=1.000000000E-05 -s initial.crank_speed=200 "$work/base.nml"
field() { awk -F, -v name="$2" '$1 == name { print $2 }' "$1"; }
check "a row has the results of the case: largest residual" [ "$(field "$work/single/base.summary.csv" max_energy_residual_relative)" = \
  "$(awk -F, '$1 == 2 { print $16 }' "$work/one/grid.runs.csv")" ]
check "a row has the results of the case: evaluations" [ "$(field "$work/single/base.summary.csv" rhs_evaluations)" = \
  "$(awk -F, '$1 == 2 { print $17 }' "$work/one/grid.runs.csv")" ]

same() {   # same NAME FOLDER: all files of the grid are those of one process
  for kind in runs cycles strobe; do
    check "$1: $kind" cmp -s "$work/one/grid.$kind.csv" "$2/grid.$kind.csv"
  done
}

run sweep -j 4 -o "$work/four" "$work/grid.nml"
same "four processes" "$work/four"

# units
study units <<'END'
&study case = 'base.nml', cycles = T, strobe_columns = 'crank_angle, eccentricity_x', strobe_angle_deg = 90 /
&parameter key = 'joint.clearance', from = 10 um, to = 0.04mm, count = 4, scale = 'log' /
&parameter key = 'initial.crank_speed', values = 100 rad/s, '200 rad/s, 300rad/s' /
END
run sweep -o "$work/units" "$work/units.nml"
check "a study with units, status $status" [ "$status" = 0 ]
sed 's/,3e2,/,300,/' "$work/one/grid.runs.csv" >"$work/in_si.csv"
check "a study with units is the study in SI" cmp -s "$work/in_si.csv" "$work/units/units.runs.csv"
sed 's/0.04mm/40 K/' "$work/units.nml" >"$work/kelvin.nml"
refused "a unit of another kind" 3 "kelvin.nml:2: &parameter to = 40 K: K is a temperature; clearance is a length (m, km" "$work/kelvin.nml"
sed "s/200 rad/200 rda/" "$work/units.nml" >"$work/rda.nml"
refused "a unit that there is not" 3 "rda.nml:3: &parameter values = 200 rda/s: unknown unit; did you mean rad/s?" "$work/rda.nml"

study short <<'END'
&study case = 'base.nml', settle_cycles = 40 /
&parameter key = 'joint.clearance', values = 10 um /
END
refused "a study that leaves nothing of its runs" 3 "short.nml: &study settle_cycles = 40: the case makes 4 revolutions, no whole one is left" \
  -s drive.kind=constant_speed "$work/short.nml"

study tables <<'END'
&study case = 'base.nml', table = 'tables.csv' /
END
printf 'joint.clearance\n1e-5\n20 um\n' >"$work/tables.csv"
run sweep -o "$work/units" "$work/tables.nml"
check "a table with units, status $status" [ "$status" = 0 ]
mv "$work/units/tables.runs.csv" "$work/with_units.csv"
printf 'joint.clearance\n1e-5\n2e-5\n' >"$work/tables.csv"
run sweep --fresh -o "$work/units" "$work/tables.nml"
check "a table with units is the table in SI" cmp -s "$work/with_units.csv" "$work/units/tables.runs.csv"
printf 'joint.clearance\n1e-5\n20 K\n' >"$work/tables.csv"
refused "a unit of another kind in a table" 3 "tables.csv:3: column 1, joint.clearance = 20 K: K is a temperature; clearance is a length (m, km" "$work/tables.nml"

# parts
run sweep -o "$work/parts" --rows 1:5 "$work/grid.nml"
check "a part of the rows, got $(cat "$work/out")" grep -q '5 runs; .*; .*grid.chunks$' "$work/out"
check "a part alone gives no table" [ ! -e "$work/parts/grid.runs.csv" ]
run sweep -o "$work/parts" --rows 4:9 "$work/grid.nml"
check "rows that are done are not run again, got $(cat "$work/out")" grep -q '6 runs, 2 of them already done;' "$work/out"
run sweep -o "$work/parts" "$work/grid.nml"
check "the last sweep runs the remaining rows, got $(cat "$work/out")" grep -q '12 runs, 9 of them already done;.*grid.runs.csv$' "$work/out"
same "parts" "$work/parts"
check "no parts are left" [ ! -e "$work/parts/grid.chunks" ]

# a start of the rows that only the slow run reaches: without traces the other does not fail
sed 's/ideal_twin = .true./start_time = 0.05/' "$work/base.nml" >"$work/late_rows.nml"
for traces in none all; do
  study late_$traces <<END
&study case = 'late_rows.nml', traces = '$traces' /
&parameter key = 'initial.crank_speed', values = 250, 1000 /
END
done
run sweep --check "$work/late_none.nml"
check "late rows that no run writes" [ "$status" = 0 -a "$(cat "$work/out")" = "$work/late_none.nml: correct, 2 runs" ]
run sweep --check "$work/late_all.nml"
check "a run that would write no row fails" [ "$(cat "$work/out")" = "$work/late_all.nml: 2 runs, 1 would fail" ]

# the crank pin: its columns come after those of every study and are empty if it is ideal
cp cases/joints/both_pins.nml "$work/both.nml"
study pins <<'END'
&study case = 'both.nml', cycles = T /
&parameter key = 'crank_pin.joint.clearance', values = 5e-5, 1e-4 /
END
run sweep -j 1 -o "$work/pins" "$work/pins.nml"
check "a study of the crank pin is run, status $status" [ "$status" = 0 ]
check "every row with a crank pin has every column" [ "$(awk -F, '{print NF}' "$work/pins/pins.runs.csv" | sort -u)" = 26 ]
check "every revolution with a crank pin has every column" [ "$(awk -F, '{print NF}' "$work/pins/pins.cycles.csv" | sort -u)" = 17 ]
run -q -o "$work/single" -s crank_pin.joint.clearance=1e-4 "$work/both.nml"
named() { awk -F, -v row="$2" -v name="$3" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) k = i } NR == row + 1 { print $k }' "$1"; }
for quantity in 'min_film_thickness m' 'max_penetration m' 'max_pin_force N'; do
  for pin in '' crank_pin_; do
    check "a run has the results of the case: $pin${quantity% *}" [ "$(named "$work/pins/pins.runs.csv" 2 "$pin${quantity% *}[${quantity#* }]")" = \
      "$(field "$work/single/both.summary.csv" "$pin${quantity% *}")" ]
  done
done

# one number of a list
study element <<'END'
&study case = 'base.nml' /
&parameter key = 'mechanism.rod_com[2]', from = -1 mm, to = 1 mm, count = 3 /
END
run sweep -o "$work/element" "$work/element.nml"
check "a study of one number of a list, status $status" [ "$status" = 0 ]
run -o "$work/element" -s 'mechanism.rod_com[2]=1.000000000E-03' "$work/base.nml"
check "its rows are those of the cases" [ "$(field "$work/element/base.summary.csv" max_pin_force)" = \
  "$(named "$work/element/element.runs.csv" 3 'max_pin_force[N]')" ]
check "its values differ" [ "$(named "$work/element/element.runs.csv" 1 'max_pin_force[N]')" != \
  "$(named "$work/element/element.runs.csv" 3 'max_pin_force[N]')" ]
sed "s/from.*/values = 0, 1 \/\n\&parameter key = 'mechanism.rod_com(2)', values = 1, 2 \//" "$work/element.nml" >"$work/twice.nml"
refused "an override of a key of which one number is varied" 2 "the study varies mechanism.rod_com" -s mechanism.rod_com=0.05,0 "$work/element.nml"
refused "the same number twice" 3 "twice.nml:[0-9]*: mechanism.rod_com(2): is varied twice, also as mechanism.rod_com\\[2\\]" "$work/twice.nml"

# wear: columns of the worn surfaces, where a run may have any
cp cases/wear/flores.nml "$work/rubbing.nml"
study worn <<'END'
&study case = 'rubbing.nml' /
&parameter key = 'joint.clearance', values = 4e-4, 5e-4 /
END
run sweep -o "$work/worn" "$work/worn.nml"
run -o "$work/worn" -s joint.clearance=5e-4 "$work/rubbing.nml"
for quantity in "worn_volume_pin m3" "worn_volume_bore m3" "max_wear_depth_pin m" "max_wear_depth_bore m"; do
  check "a run has the results of the case: ${quantity% *}" [ "$(named "$work/worn/worn.runs.csv" 2 "${quantity% *}[${quantity#* }]")" = \
    "$(field "$work/worn/rubbing.summary.csv" "${quantity% *}")" ]
done
check "the two runs wear differently" [ "$(named "$work/worn/worn.runs.csv" 1 'worn_volume_bore[m3]')" != \
  "$(named "$work/worn/worn.runs.csv" 2 'worn_volume_bore[m3]')" ]

check "the two pins have different forces" [ "$(named "$work/pins/pins.runs.csv" 2 'mean_pin_force[N]')" != \
  "$(named "$work/pins/pins.runs.csv" 2 'crank_pin_mean_pin_force[N]')" ]
# the integral of the force against a trace with close rows
close() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a - b < 0.02 * b && b - a < 0.02 * b) }'; }
run -q -o "$work/fine" -s crank_pin.joint.clearance=1e-4 -s output.samples_per_revolution=100000 "$work/both.nml"
for names in 'pin_force_x[N] pin_force_y[N] mean_pin_force[N]' \
    'crank_pin_normal_force[N] crank_pin_friction_force[N] crank_pin_mean_pin_force[N]'; do
  set -- $names
  mean=$(awk -F, -v x="$1" -v y="$2" 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i == x) a = i; if ($i == y) b = i }; next }
    { sum += sqrt($a * $a + $b * $b) } END { print sum / (NR - 1) }' "$work/fine/both.csv")
  check "$3: mean of the rows of the trace is $mean" close "$mean" "$(named "$work/pins/pins.runs.csv" 2 "$3")"
done
study pins <<'END'
&study case = 'both.nml', cycles = T /
&parameter key = 'crank_pin.joint.kind', values = 'clearance', 'ideal' /
END
run sweep -j 1 -o "$work/ideal" "$work/pins.nml"
check "a study with an ideal crank pin, status $status" [ "$status" = 0 ]
check "an ideal crank pin has no results" [ -z "$(named "$work/ideal/pins.runs.csv" 2 'crank_pin_max_pin_force[N]')" ]
check "the piston pin beside an ideal crank pin has results" [ -n "$(named "$work/ideal/pins.runs.csv" 2 'max_penetration[m]')" ]

# the piston in its bore
cp cases/joints/piston_slap.nml "$work/slap.nml"
study bore <<'END'
&study case = 'slap.nml' /
&parameter key = 'guide.bore_clearance', values = 5e-5, 2e-4 /
&parameter key = 'guide.restitution', values = 0.3, 0.9 /
&parameter key = 'initial.piston_offset', values = 0, 2e-5 /
END
run sweep -j 2 -o "$work/bore" "$work/bore.nml"
check "a study of the bore is run, status $status" [ "$status" = 0 ]
run -q -o "$work/single" -s guide.bore_clearance=2e-4 -s guide.restitution=0.3 -s initial.piston_offset=2e-5 "$work/slap.nml"
for names in 'energy_residual[-] max_energy_residual_relative' 'rhs_evaluations[-] rhs_evaluations' 'max_pin_force[N] max_pin_force'; do
  check "a run has the results of the case: $names" [ "$(named "$work/bore/bore.runs.csv" 6 "${names% *}")" = "$(field "$work/single/slap.summary.csv" "${names#* }")" ]
done
# statistics of the skirt's corners, against the case's own events and summary
study skirt <<'END'
&study case = 'slap.nml', cycles = T /
&parameter key = 'guide.bore_clearance', values = 2e-4 /
&parameter key = 'guide.kind', values = 'clearance', 'friction' /
END
run sweep -j 1 -o "$work/skirt" -s drive.kind=constant_speed "$work/skirt.nml"
check "a study with and without clearance in the bore is run, status $status" [ "$status" = 0 ]
run -q -o "$work/single" -s drive.kind=constant_speed -s guide.bore_clearance=2e-4 "$work/slap.nml"
largest() { awk -F, -v name="$1" '$1 ~ "^guide_[1-4]_" name "$" && $2 + 0 >= most + 0 { most = $2 } END { print most }' "$work/single/slap.summary.csv"; }
check "largest penetration of the corners" [ "$(named "$work/skirt/skirt.runs.csv" 1 'guide_max_penetration[m]')" = "$(largest max_penetration)" ]
check "largest force of the corners" [ "$(named "$work/skirt/skirt.runs.csv" 1 'guide_max_force[N]')" = "$(largest max_force)" ]
check "contacts of the corners per revolution" [ "$(awk -F, '/contact_begins.*guide_/ { n++ } END { printf "%.9E", n / 2 }' "$work/single/slap.events.csv")" = \
  "$(named "$work/skirt/skirt.runs.csv" 1 'guide_impacts[-]')" ]
check "contacts of the corners in each revolution" [ "$(awk -F, '/contact_begins.*guide_/ { n++ } END { print n }' "$work/single/slap.events.csv")" = "$((
  $(named "$work/skirt/skirt.cycles.csv" 1 'guide_impacts[-]') + $(named "$work/skirt/skirt.cycles.csv" 2 'guide_impacts[-]')))" ]
check "one of the revolutions has the largest force" [ "$(for i in 1 2; do named "$work/skirt/skirt.cycles.csv" $i 'guide_max_force[N]'; done | sort -g | tail -n 1)" = "$(largest max_force)" ]
check "share of the time with a corner in contact" awk -v a="$(named "$work/skirt/skirt.runs.csv" 1 'guide_contact_time_fraction[-]')" \
  -v b="$(largest contact_time_fraction)" 'BEGIN { exit !(a >= b && a < 1) }'
check "an ideal guide has no results of corners" [ -z "$(named "$work/skirt/skirt.runs.csv" 2 'guide_impacts[-]')" ]
study kinds <<'END'
&study case = 'slap.nml' /
&parameter key = 'guide.kind', values = 'clearance', 'friction' /
&parameter key = 'guide.viscous', values = 0, 10 /
END
run sweep -j 1 -o "$work/kinds" "$work/kinds.nml"
check "a study of kinds of guide is run, status $status" [ "$status" = 0 ]
check "all runs with different guides differ" [ "$(awk -F, 'NR > 1' "$work/kinds/kinds.runs.csv" | cut -d, -f5- | sort -u | wc -l)" = 4 ]

# every key of joints with clearance and elastic members can vary in a study and changes the run
run -q -o "$work/all" -s integrator.revolutions=0.1 -s crank_pin.joint.kind=clearance -s crank_pin.joint.clearance=1e-4 \
  -s crank_pin.joint.bearing_radius=0.012 -s guide.law=stribeck -s guide.coefficient=0.05 -s guide.static_coefficient=0.08 \
  -s guide.transition_speed=0.5 -s guide.stribeck_speed=0.1 -s elastic_rod.section_area=9.6e-5 -s elastic_rod.section_inertia=5.12e-10 \
  -s crankshaft.flywheel_inertia=0.02 -s crankshaft.torsional_stiffness=2e4 "$work/slap.nml"
check "a scene with all clearances and elastic members, status $status" [ "$status" = 0 ]
awk -v q="'" '/^&/ { group = substr($1, 2) } $1 == "place" { group = substr($3, 2, length($3) - 2) "." group }
  group ~ /^(guide|elastic_rod|crankshaft|crank_pin.joint)$/ && $3 ~ /^[-0-9.]/ && !/,.*!/ && $1 !~ /^(bearing_length|load_share|half_angle_deg|barrel|barrel_height|ovality)$/ &&
    !(group == "crankshaft" && $1 !~ /^(flywheel_inertia|torsional_stiffness|torsional_damping)$/) { print group "." $1, $3 + 0 }
  group == "initial" && $1 ~ /^piston_/ { print group "." $1, $3 + 0 }' "$work/all/slap.resolved.nml" >"$work/keys"
check "number of keys of these groups" [ "$(wc -l <"$work/keys")" -ge 34 ]
run -q -o "$work/all" -s integrator.revolutions=0.1 cases/joints/skirt.nml
for key in half_angle_deg barrel barrel_height ovality; do   # of the film at a skirt
  echo "guide.$key $(sed -n "s/^  $key = \([^ ]*\).*/\1/p" "$work/all/skirt.resolved.nml")" >>"$work/keys"
done
stuck=
while read -r key value; do
  base=slap
  case $key in
    *_modes | *_shapes) other=$((value + 1)) ;;
    *.dissipation) value=0.3 other=0.4 ;;
    *.shank_mass) value=0.2 other=0.19 ;;
    *.exponent) other=1.01 ;;
    *.least_impact_speed) other=1 ;;
    guide.barrel_height) base=skirt other=5e-3 ;;
    guide.half_angle_deg | guide.barrel | guide.ovality) base=skirt other=$(awk -v v="$value" 'BEGIN { print v == 0 ? 1e-6 : 0.95 * v }') ;;
    *) other=$(awk -v v="$value" 'BEGIN { print v == 0 ? 1e-4 : 0.99 * v }') ;;
  esac
  printf "&study case = '%s' /\n&parameter key = '%s', values = %s, %s /\n" "$work/all/$base.resolved.nml" "$key" "$value" "$other" >"$work/key.nml"
  run sweep --fresh -j 1 -o "$work/key" -s integrator.revolutions=1.05 -s integrator.relative_tolerance=1e-4 -s drive.kind=constant_speed \
    "$work/key.nml"
  [ "$status" = 0 ] && [ "$(awk -F, 'NR > 1' "$work/key/key.runs.csv" | cut -d, -f4- | sort -u | wc -l)" = 2 ] || stuck="$stuck $key"
done <"$work/keys"
check "keys without effect in a study, or refused:$stuck" [ -z "$stuck" ]
# tables: a key together with a table, and the table itself as a parameter; each run against a single one
cp cases/gas/measured.nml cases/gas/indicator.csv cases/drive/motor.nml cases/drive/motor.csv "$work"
sed 's/^0,30$/0,20/' "$work/motor.csv" >"$work/weak.csv"
study gas <<'END'
&study case = 'measured.nml' /
&parameter key = 'cylinder_pressure.offset_deg', values = -5, 0, 5 /
END
study motors <<'END'
&study case = 'motor.nml' /
&parameter key = 'drive.torque_table', values = 'motor.csv', 'weak.csv', 'none.csv' /
END
run sweep -j 1 -o "$work/tables" -s integrator.method=auto "$work/gas.nml"
check "a study with a table of pressures, status $status" [ "$status" = 0 ]
run -q -o "$work/tables" -s integrator.method=auto -s cylinder_pressure.offset_deg=5 "$work/measured.nml"
for names in 'rhs_evaluations[-] rhs_evaluations' 'max_pin_force[N] max_pin_force'; do
  check "a run with a table has the results of the case: $names" [ "$(named "$work/tables/gas.runs.csv" 3 "${names% *}")" = "$(field "$work/tables/measured.summary.csv" "${names#* }")" ]
done
run sweep -j 1 -o "$work/tables" -s integrator.method=auto "$work/motors.nml"
check "a study over tables with a missing one, status $status" [ "$status" = 4 ]
check "the row of a missing table names it" grep -q '^3,.*none.csv: No such file' "$work/tables/motors.runs.csv"
run -q -o "$work/tables" -s integrator.method=auto -s drive.torque_table=weak.csv "$work/motor.nml"
check "a run over tables has the results of the case" [ "$(named "$work/tables/motors.runs.csv" 2 'rhs_evaluations[-]')" = "$(field "$work/tables/motor.summary.csv" rhs_evaluations)" ]
check "the weaker motor gives a lower speed" awk -v a="$(named "$work/tables/motors.runs.csv" 1 'mean_crank_speed[rad/s]')" \
  -v b="$(named "$work/tables/motors.runs.csv" 2 'mean_crank_speed[rad/s]')" 'BEGIN { exit !(b < 0.95*a) }'

# runs until the motion is periodic: period, exponent, statistics of the last period only
cp cases/flores/lubricated_400cP.nml "$work/film.nml"
study periods <<'END'
&study case = 'film.nml', cycles = T /
&parameter key = 'joint.clearance', values = 4e-4, 5e-4 /
END
run sweep -j 1 -o "$work/periods" -s run.until=periodic -s output.window=last_period -s run.lyapunov_revolutions=5 \
  -s integrator.method=auto "$work/periods.nml"
check "runs until the motion is periodic, status $status" [ "$status" = 0 ]
check "every row has every column" [ "$(awk -F, '{print NF}' "$work/periods/periods.runs.csv" | sort -u)" = 21 ]
for row in 1 2; do
  check "run $row: period of one revolution" [ "$(named "$work/periods/periods.runs.csv" $row 'period_revolutions[-]')" = 1 ]
  check "run $row: negative Lyapunov exponent" awk -v a="$(named "$work/periods/periods.runs.csv" $row 'lyapunov_exponent[1/revolution]')" \
    'BEGIN { exit !(a < -5 && a > -15) }'
  check "run $row: statistics of one revolution" [ "$(named "$work/periods/periods.runs.csv" $row 'cycles[-]')" = 1 ]
done
check "the revolution of the statistics has its number" [ "$(awk -F, 'NR > 1 && $2 < 5' "$work/periods/periods.cycles.csv" | wc -l)" = 0 ]

# files left by a program that was killed: whole chunks, and one that was being written
mkdir -p "$work/torn/grid.chunks"
cp "$work/one/grid.study.nml" "$work/torn"
for run in 4 9; do
  for kind in runs cycles strobe; do
    { head -n 1 "$work/one/grid.$kind.csv"; grep "^$run," "$work/one/grid.$kind.csv"; } >"$work/torn/grid.chunks/$run-$run.$kind.csv"
  done
done
printf 'run,joint.clea' >"$work/torn/grid.chunks/5-5.runs.csv.part"
run sweep -o "$work/torn" "$work/grid.nml"
check "a killed sweep is continued, got $(cat "$work/out")" grep -q '12 runs, 2 of them already done' "$work/out"
same "continued" "$work/torn"
run sweep -o "$work/torn" "$work/grid.nml"
check "nothing is run twice" grep -q '12 runs, 12 of them already done; [^;]*csv$' "$work/out"
same "run again" "$work/torn"
run sweep -o "$work/torn" -a draft "$work/grid.nml"
check "results of another base case are refused, status $status" [ "$status" = 5 ]
check "the message about another base case names --fresh" grep -q 'grid.runs.csv: belongs to another study.*--fresh' "$work/err"
run sweep -o "$work/torn" -s initial.crank_angle_deg=10 --fresh "$work/grid.nml"
check "--fresh discards earlier runs, status $status" [ "$status" = 0 ]
check "--fresh with another base case gives other results" [ "$(cmp -s "$work/torn/grid.runs.csv" "$work/one/grid.runs.csv"; echo $?)" = 1 ]

# links with the temporary names are replaced, and their targets are unchanged
mkdir "$work/linked"
for kind in runs.csv cycles.csv strobe.csv study.nml; do
  echo precious >"$work/precious.$kind"
  ln -s "../precious.$kind" "$work/linked/grid.$kind.part"
done
run sweep -o "$work/linked" "$work/grid.nml"
check "a sweep in a folder with links, status $status" [ "$status" = 0 ]
same "in a folder with links" "$work/linked"
for kind in runs.csv cycles.csv strobe.csv study.nml; do
  check "target of a link at grid.$kind.part is unchanged" [ "$(cat "$work/precious.$kind")" = precious ]
  check "grid.$kind is not a link" [ ! -L "$work/linked/grid.$kind" ]
done
mkdir -p "$work/folder/grid.runs.csv.part"
run sweep -o "$work/folder" "$work/grid.nml"
check "a folder with a temporary name: status 5, got $status" [ "$status" = 5 ]
check "the message names a folder with a temporary name" grep -q 'grid.runs.csv: Is a directory' "$work/err"

# results that were cut, as by a power failure, are noticed and run again
cut_results() {   # cut_results NAME FILE SIZE: one of the files of a chunk of two runs, cut
  rm -rf "$work/broken"
  run sweep -o "$work/broken" --rows 1:12 "$work/grid.nml"
  mkdir -p "$work/broken/grid.chunks"
  for kind in runs cycles strobe; do
    { head -n 1 "$work/one/grid.$kind.csv"; grep -e '^3,' -e '^4,' "$work/one/grid.$kind.csv"; } >"$work/broken/grid.chunks/3-4.$kind.csv"
    for run in 1 2 5 6 7 8 9 10 11 12; do
      { head -n 1 "$work/one/grid.$kind.csv"; grep "^$run," "$work/one/grid.$kind.csv"; } >"$work/broken/grid.chunks/$run-$run.$kind.csv"
    done
  done
  rm -f "$work/broken/grid.runs.csv"
  truncate -s "$3" "$work/broken/grid.chunks/3-4.$2.csv"
  run sweep -o "$work/broken" "$work/grid.nml"
  check "$1: status 0, got $status: $(cat "$work/err")" [ "$status" = 0 -a ! -s "$work/err" ]
  check "$1: 2 runs again, got $(cat "$work/out")" grep -q '12 runs, 10 of them already done;' "$work/out"
  same "$1" "$work/broken"
}
cut_results "a cut row" runs -20
cut_results "no rows" runs 0
cut_results "no revolutions" cycles 0
cut_results "a cut strobe" strobe -3
last=$(grep '^4,' "$work/one/grid.cycles.csv" | tail -n 1)
cut_results "a revolution is missing" cycles "-$((${#last} + 1))"

# a study that had ended and has lost rows since is completed
lose_rows() {   # lose_rows NAME COMMAND...: change a file of the results in the folder $work/lost by a command
  rm -rf "$work/lost"
  cp -r "$work/one" "$work/lost"
  what=$1
  shift
  "$@"
  run sweep -o "$work/lost" "$work/grid.nml"
  check "$what: not all done, got $(cat "$work/out")" [ "$status" = 0 -a "$(grep -c 'already done' "$work/out")" = 0 ]
  same "$what" "$work/lost"
}
lose_rows "the last strobes are missing" sed -i '$d' "$work/lost/grid.strobe.csv"
lose_rows "a revolution in the middle is missing" sed -i '7d' "$work/lost/grid.cycles.csv"
lose_rows "no file of revolutions" rm "$work/lost/grid.cycles.csv"
lose_rows "zeros in the place of text" truncate -s +4096 "$work/lost/grid.strobe.csv"
sed "s/cycles = T/traces = 'all'/" "$work/grid.nml" >"$work/traced.nml"
run sweep -o "$work/broken" "$work/traced.nml"
check "every run has a trace" [ "$(ls "$work/broken/traced" | grep -c '[0-9].csv')" = 12 ]

# a real kill, and a termination signal
study long <<'END'
&study case = 'base.nml', cycles = T, strobe_columns = 'pin_force_x' /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 60 /
&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02, count = 50 /
END
run sweep -o "$work/whole" "$work/long.nml"
for signal in KILL TERM; do
  "$gudgeon" sweep -j 2 -o "$work/$signal" "$work/long.nml" >"$work/out" 2>"$work/err" &
  pid=$!
  tries=0
  while [ "$(ls "$work/$signal/long.chunks" 2>/dev/null | grep -c 'runs.csv$')" -lt 5 ] && [ $tries -lt 3000 ]; do
    tries=$((tries + 1))
    sleep 0.02
  done
  kill -$signal $pid
  wait $pid 2>/dev/null
  status=$?
  chunks=$(ls "$work/$signal/long.chunks" | grep -c 'runs.csv$')
  check "$signal: stopped before the end, $chunks chunks" [ "$chunks" -ge 5 -a "$chunks" -lt 200 -a ! -e "$work/$signal/long.runs.csv" ]
  tries=0   # the processes of a killed sweep end with it
  while pgrep -f "sweep -j 2 -o $work/$signal" >/dev/null && [ $tries -lt 1500 ]; do tries=$((tries + 1)); sleep 0.02; done
  check "$signal: no process is left" [ $tries -lt 1500 ]
  [ "$signal" = TERM ] && check "interrupted: exit status 4, got $status" [ "$status" = 4 ]
  [ "$signal" = TERM ] && check "interrupted: the message names the command that continues" grep -q 'interrupted after .* of 3000 runs; the same command' "$work/err"
  run sweep -o "$work/$signal" "$work/long.nml"
  check "$signal: continued" grep -q 'of them already done' "$work/out"
  check "$signal: the same runs" cmp -s "$work/whole/long.runs.csv" "$work/$signal/long.runs.csv"
  check "$signal: the same revolutions" cmp -s "$work/whole/long.cycles.csv" "$work/$signal/long.cycles.csv"
done

# a process of the sweep is killed: its rows are named, the others are kept; again if the signal met it between two chunks
for attempt in 1 2 3; do
  rm -rf "$work/lost"
  "$gudgeon" sweep -j 2 -o "$work/lost" "$work/long.nml" >"$work/out" 2>"$work/err" &
  pid=$!
  tries=0
  while [ "$(ls "$work/lost/long.chunks" 2>/dev/null | grep -c 'runs.csv$')" -lt 5 ] && [ $tries -lt 3000 ]; do
    tries=$((tries + 1))
    sleep 0.02
  done
  kill -KILL "$(pgrep -P $pid | head -n 1)"
  wait $pid
  status=$?
  grep -q 'was killed by signal 9' "$work/err" && [ "$(ls "$work/lost/long.chunks" | grep -c 'runs.csv$')" = 199 ] && break
done
check "a process of the sweep is killed: status 4, got $status" [ "$status" = 4 ]
check "the message names its runs: $(cat "$work/err")" \
  grep -q 'long.nml: the process of the runs [0-9]* to [0-9]* was killed by signal 9; the results of other runs are kept' "$work/err"
check "the other process has done the other chunks" [ "$(ls "$work/lost/long.chunks" | grep -c 'runs.csv$')" = 199 ]
run sweep -o "$work/lost" "$work/long.nml"
check "the same command runs its rows, got $(cat "$work/out")" grep -q '3000 runs, 2985 of them already done' "$work/out"
check "a killed process: the same runs" cmp -s "$work/whole/long.runs.csv" "$work/lost/long.runs.csv"

# a full disk
( ulimit -f 4; "$gudgeon" sweep -j 2 -o "$work/full" "$work/long.nml" >"$work/out" 2>"$work/err" )
check "a full disk: status 5, got $?" [ $? = 0 -o -s "$work/err" ]
check "a full disk is named: $(cat "$work/err")" grep -q 'long.*csv: File too large' "$work/err"

# a large study is checked quickly, and a signal ends the program at once
study large <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 200 /
&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02, count = 200 /
&parameter key = 'initial.crank_speed', from = 100, to = 200, count = 10 /
&parameter key = 'mechanism.piston_mass', from = 0.5, to = 1, count = 25 /
END
(ulimit -t 100; exec "$gudgeon" sweep --check "$work/large.nml") >"$work/out"
check "a large grid is checked, status $?" [ "$(cat "$work/out")" = "$work/large.nml: correct, 10000000 runs (100000 of them checked)" ]
study large_grid <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 3000 /
&parameter key = 'lubrication.viscosity', from = 0.005, to = -1e-9, count = 3000 /
END
(ulimit -t 100; exec "$gudgeon" sweep --check "$work/large_grid.nml") >"$work/out" 2>"$work/err"
check "a large grid with a wrong last value, status $?" grep -q 'run 3000: .*viscosity = -1.000000000E-09: must be > 0' "$work/err"
for signal in INT TERM; do
  timeout -k 60 -s $signal 0.3 "$gudgeon" sweep -o "$work/large" "$work/large.nml" 2>/dev/null
  check "$signal at the start of a large sweep, status $?" [ $? != 137 ]
done

# a table that is missing
echo "&study case = 'base.nml', table = 'gone.csv' /" >"$work/gone.nml"
run sweep -o "$work" "$work/gone.nml"
check "a table that is missing: study, key and file, status $status: $(cat "$work/err")" \
  [ "$status" = 3 -a "$(cat "$work/err")" = "gudgeon: $work/gone.nml: &study table: $work/gone.csv: No such file or directory" ]

# one long field in a table
awk 'BEGIN { print "case.title,joint.clearance"; for (i = 1; i < 20000; i++) print "a" i ",2e-5"
  for (i = 0; i < 60000; i++) printf "0123456789"; print ",2e-5" }' >"$work/wide.csv"
study wide <<'END'
&study case = 'base.nml', table = 'wide.csv' /
END
( ulimit -v 1000000; "$gudgeon" sweep --check "$work/wide.nml" 2>"$work/err" )
check "a table with one long field, status $?: $(cat "$work/err")" grep -q 'wide.csv:20001: column 1, .*must be at most 4000 bytes' "$work/err"

# several long titles
awk 'BEGIN { print "case.title,joint.clearance"; for (i = 0; i < 3; i++) { for (k = 0; k < 400; k++) printf "0123456789"; print ",2e-5" } }' \
  >"$work/long_titles.csv"
study long_titles <<'END'
&study case = 'base.nml', table = 'long_titles.csv' /
END
run sweep --check "$work/long_titles.nml"
check "titles of 4000 bytes, status $status: $(cat "$work/err")" [ "$status" = 0 ]

# titles that contain the word done, or begin like a formula
printf 'case.title,joint.clearance,rod_com\n"a,done,b",-1e-5\n"=1+1, x",2e-5\n-a,2e-5\n-5,3e-5\n"\047=1",2e-5\n' | sed 's/,rod_com//' >"$work/titles.csv"
study titles <<'END'
&study case = 'base.nml', table = 'titles.csv' /
END
for time in first second; do
  run sweep -o "$work/titles" "$work/titles.nml"
  check "a title that contains done, $time time: status 4, got $status" [ "$status" = 4 ]
  check "a title that contains done, $time time: one run failed" grep -q 'titles.nml: 1 of 5 runs failed' "$work/err"
done
check "titles that begin like formulas" [ "$(tail -n +3 "$work/titles/titles.runs.csv" | sed 's/,[23]e-5,done.*//')" = \
  "$(printf '2,"\047=1+1, x"\n3,\047-a\n4,-5\n5,\047=1')" ]

# a table; runs that fail keep the reason and do not stop others
printf '\357\273\277joint.clearance,lubrication.law,lubrication.kinematic_viscosity,"integrator.max_evaluations"\r\n2e-5,pinkus_sternlicht,0,100000\r\n-1e-5,pinkus_sternlicht,0,100000\r\n2e-5,oscillating_film,1.38e-5,"100000"\r\n2e-5,oscillating_film,0,100000\r\n2e-5,pinkus_sternlicht,0,500\r\n' >"$work/table.csv"
study table <<'END'
&study case = 'base.nml', table = 'table.csv', traces = 'failed' /
END
run sweep -o "$work/t" "$work/table.nml"
check "failed runs: exit status 4, got $status" [ "$status" = 4 ]
check "failed runs are counted" grep -q 'table.nml: 3 of 5 runs failed' "$work/err"
row() { sed -n "$(($1 + 1))p" "$work/t/table.runs.csv"; }
check "run 1 is done: $(row 1)" [ "$(row 1 | cut -d, -f 6)" = done ]
check "run 2 states the reason: $(row 2)" [ "$(row 2 | cut -d, -f 6)" = '&joint clearance = -1e-5: must be > 0 (m)' ]
check "run 3 is done: $(row 3)" [ "$(row 3 | cut -d, -f 6)" = done ]
check "run 4 states the reason: $(row 4)" [ "$(row 4 | cut -d, -f 6 | cut -c 1-35)" = '&lubrication kinematic_viscosity = ' ]
check "run 5 states the reason: $(row 5)" [ "$(row 5 | grep -c 'max_evaluations) at t = ')" = 1 ]
check "a run that failed after its start has a trace" [ -s "$work/t/table/5.csv" -a "$(ls "$work/t/table" | wc -l)" = 2 ]
run sweep -o "$work/t" "$work/table.nml"
check "failed runs are not repeated and still count as failed" [ "$status" = 4 ]

# messages
study own <<END
&study case='$PWD/cases/film/heat.nml' /
&parameter key='lubrication.temperature' values='370, 380' /
END
refused "a group that the case has for one joint" 3 "&lubrication: the case has this group for crank_pin: write crank_pin.lubrication.temperature" "$work/own.nml"
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearence', from = 1e-5, to = 2e-5, count = 2 /
END
refused "misspelt key" 3 "bad.nml:2: &joint clearence: unknown key; did you mean clearance" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', frm = 1e-5, to = 2e-5, count = 2 /
END
refused "misspelt key of the study" 3 "bad.nml:2: &parameter frm: unknown key; did you mean from" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', from = 1e-5, to = 2e-5 /
END
refused "no count" 3 "&parameter count.*required with from and to" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml', table = 'bad.csv' /
END
refused "no table" 3 "bad.csv: No such file" "$work/bad.nml"
printf 'joint.clearance,initial.crank_speed\n1e-5,100\n2e-5,fast\n' >"$work/bad.csv"
refused "text for a number" 3 "bad.csv:3: column 2, initial.crank_speed = fast: must be a number" "$work/bad.nml"
printf 'joint.clearance,initial.crank_speed\n1e-5\n' >"$work/bad.csv"
refused "a short row" 3 "bad.csv:2: .*the header has 2 fields, this row fewer" "$work/bad.nml"
study bad <<'END'
&study case = 'none.nml' /
&parameter key = 'joint.clearance', values = 1e-5 /
END
refused "no base case" 3 "bad.nml: &study case: .*none.nml: No such file" "$work/bad.nml"
refused "no study" 2 "no study file"
refused "a case for a study" 3 "sim_I.nml:[0-9]*: &case: .*run it with gudgeon cases/sim_I.nml, without sweep" cases/sim_I.nml
study ends <<'END'
&study case = 'base.nml' /
&parameter key = 'integrator.end_time', values = 0.035, 0.065 /
END
run -q sweep -o "$work/ends" -s integrator.revolutions=1 "$work/ends.nml"
check "a parameter for the end of the run replaces the revolutions of the case, status $status" [ "$status" = 0 ]
check "the runs end at the values of the parameter" [ "$(awk -F, 'NR > 1 { printf "%s ", $4 }' "$work/ends/ends.runs.csv")" = "1 2 " ]
run sweep -q -o "$work/dry" -s lubrication=none -s integrator.revolutions=2 -s contact.restitution=0.5 "$work/grid.nml"
check "a sweep with the film removed has impacts" [ "$(awk -F, 'NR > 1 && $8 > 0' "$work/dry/grid.runs.csv" | wc -l)" -gt 6 ]
run --fresh cases/sim_I.nml
check "--fresh is refused for cases" [ "$status" = 2 ]
refused "rows beyond the study" 3 "the study has 12 runs" --rows 5:20 "$work/grid.nml"
cp cases/bearings/flores2006.nml cases/bearings/flores2006.load.csv "$work"
study alone <<'END'
&study case = 'flores2006.nml', statistics = 'cycle_min_film_thickness' /
&parameter key = 'joint.clearance', values = 25 um, 35.56 um /
END
run sweep -q -o "$work/alone" "$work/alone.nml"
check "a study of a bearing by itself, status $status" [ "$status" = 0 ]
run -q -o "$work/alone" "$work/flores2006.nml"
film=$(sed -n 's/^cycle_min_film_thickness,\([^,]*\),m$/\1/p' "$work/alone/flores2006.summary.csv")
check "has the film of its run, $film" [ -n "$film" -a "$(grep -c "^2,.*,$film\(,\|\$\)" "$work/alone/alone.runs.csv")" = 1 ]
refused "an override of a varied key" 2 "--set Joint. clearance=3e-5: the study varies joint.clearance" \
  -s "Joint. clearance=3e-5" "$work/grid.nml"
study tolerances <<'END'
&study case = 'base.nml' /
&parameter key = 'Integrator.relative_tolerance', values = 1e-4, 1e-5 /
END
refused "an accuracy level beside a varied tolerance" 2 "--accuracy draft: the study varies integrator.relative_tolerance" \
  -a draft "$work/tolerances.nml"
study films <<'END'
&study case = 'base.nml' /
&parameter key = 'lubrication.viscosity', values = 0.01, 0.02 /
END
refused "the removal of a varied group" 2 "--set Lubrication=none: the study varies lubrication.viscosity" \
  -s Lubrication=none "$work/films.nml"
study contacts <<'END'
&study case = 'base.nml' /
&parameter key = 'contact.restitution', values = 0.5, 0.6 /
END
run sweep --check -s contact=none -s contact.law=hunt_crossley "$work/contacts.nml"
check "a group that is removed and given anew may be varied" [ "$status" = 0 ]
refused "--fresh for a part of the rows" 2 "--fresh would discard the results of other rows" --fresh --rows 1:2 "$work/films.nml"
printf 'joint.clearance\n1e-5\n' >"$work/own.runs.csv"
echo "&study case = 'base.nml', table = 'own.runs.csv' /" >"$work/own.nml"
for fresh in "" --fresh; do
  run sweep $fresh -o "$work" "$work/own.nml"
  check "a table that the results would replace is refused" [ "$status" = 2 -a "$(cat "$work/own.runs.csv" | head -n 1)" = joint.clearance ]
  check "with its key and file" grep -q "own.nml: &study table: .*own.runs.csv would be replaced by the results" "$work/err"
done
run sweep -q -o "$work/elsewhere" "$work/own.nml"
check "in another folder it is read" [ "$status" = 0 ]
run sweep -q -a draft -s integrator.revolutions=1 -o "$work/level" "$work/ends.nml"
check "an accuracy level for a study that varies other keys" [ "$status" = 0 ]
refused "rows backwards" 2 "A:B" --rows 5:4 "$work/grid.nml"
run sweep --check "$work/grid.nml"
check "--check counts the runs" [ "$status" = 0 -a "$(cat "$work/out")" = "$work/grid.nml: correct, 12 runs" ]
run sweep --check "$work/table.nml"
check "--check has the exit status of the sweep, got $status" [ "$status" = 4 ]
check "--check counts the runs that would fail" [ "$(cat "$work/out")" = "$work/table.nml: 5 runs, 2 would fail" ]
check "--check finds the invalid run" grep -q 'table.nml: run 2: .*clearance = -1e-5: must be > 0' "$work/err"
run sweep --template
cp "$work/out" "$work/template.nml"
cp "$work/base.nml" "$work/sim_I.nml"
check "the template names every key" [ "$(grep -c '^  [a-z_]* = .*  ! ' "$work/template.nml")" = 17 ]

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
