# Writes scenarios with everything drawn at random, always the same ones: FOLDER/random-01.toml and so on.
# Usage: awk -v folder=FOLDER -v count=50 -f tests/random_scenarios.awk
# Own random numbers (Park and Miller): those of awk differ from one awk to the next.

function uniform(low, high) {
  state = (state * 16807) % 2147483647
  return low + (high - low) * state / 2147483647
}

# Evenly on a logarithmic scale.
function scaled(low, high) { return low * exp(uniform(0, log(high / low))) }

function chance(probability) { return uniform(0, 1) < probability }

function either(a, b) { return chance(0.5) ? a : b }

function put(key, value) { printf "%s = %.10g\n", key, value > file }

function table(name) { printf "\n[%s]\n", name > file }

function arc_cosine(x) { return atan2(sqrt(1 - x * x > 0 ? 1 - x * x : 0), x) }

# Sets earth_x, earth_y, earth_z, from the spacecraft to the Earth at the epoch, and earth_radius_deg.
function orbit(   kind, a, e, i, raan, argp, mean, eccentric, n, true_anomaly, r, u) {
  kind = int(uniform(0, 4))
  a = kind == 0 ? uniform(6900, 8000) : kind == 1 ? 24400 : kind == 2 ? 42164 : uniform(12000, 30000)
  e = kind == 0 ? uniform(0, 0.02) : kind == 1 ? 0.73 : kind == 2 ? 0.0002 : uniform(0, 0.4)
  i = uniform(0, 110); raan = uniform(0, 360); argp = uniform(0, 360)
  mean = kind == 1 ? uniform(20, 340) : uniform(0, 360)
  table("orbit.elements")
  printf "epoch_tai_ns = %d000000000\n", start_tai_s > file
  put("a_km", a); put("e", e); put("i_deg", i); put("raan_deg", raan); put("argp_deg", argp)
  put("mean_anomaly_deg", mean)
  eccentric = mean * degree
  for (n = 0; n < 50; ++n)
    eccentric -= (eccentric - e * sin(eccentric) - mean * degree) / (1 - e * cos(eccentric))
  true_anomaly = 2 * atan2(sqrt(1 + e) * sin(eccentric / 2), sqrt(1 - e) * cos(eccentric / 2))
  r = a * (1 - e * cos(eccentric))
  u = argp * degree + true_anomaly
  earth_x = -(cos(raan * degree) * cos(u) - sin(raan * degree) * sin(u) * cos(i * degree))
  earth_y = -(sin(raan * degree) * cos(u) + cos(raan * degree) * sin(u) * cos(i * degree))
  earth_z = -sin(u) * sin(i * degree)
  earth_radius_deg = atan2(6418, sqrt(r * r - 6378 * 6378)) / degree
}

# Draws the axis at an angle from the Earth at which a beam at mount_deg mostly crosses it; sets ra_deg, dec_deg.
function axis(mount_deg,   away, turn, ra, dec, east, north, toward, x, y, z) {
  away = mount_deg + uniform(-1.1, 1.1) * earth_radius_deg
  away = (away < 1 ? 1 : away > 179 ? 179 : away) * degree
  turn = uniform(0, 360) * degree
  ra = atan2(earth_y, earth_x); dec = atan2(earth_z, sqrt(earth_x * earth_x + earth_y * earth_y))
  toward = cos(away); east = sin(away) * sin(turn); north = sin(away) * cos(turn)
  x = toward * earth_x - east * sin(ra) - north * sin(dec) * cos(ra)
  y = toward * earth_y + east * cos(ra) - north * sin(dec) * sin(ra)
  z = toward * earth_z + north * cos(dec)
  ra_deg = atan2(y, x) / degree; dec_deg = 90 - arc_cosine(z) / degree
}

function sensors(north_deg, south_deg, both,   sun_noise_s) {
  table("spin.sun_sensor")
  put("slit_cant_deg", uniform(25, 60)); put("slit_separation_deg", uniform(-60, 60))
  if (both < 0.85) {
    table("spin.ir.north"); put("mount_angle_deg", north_deg); put("azimuth_deg", uniform(0, 360))
    printf "healthy = %s\n", either("true", "false") > file
  }
  if (both > 0.15) {
    table("spin.ir.south"); put("mount_angle_deg", south_deg); put("azimuth_deg", uniform(0, 360))
  }
  table("spin.noise")
  sun_noise_s = scaled(0.002, 0.1) * degree / rate_rad_s
  put("sun_pulse_s", sun_noise_s); put("ir_pulse_s", sun_noise_s * uniform(1, 10))
  table("spin.horizon")
  printf "model = \"%s\"\n", either("sphere", "ellipsoid") > file
  put("co2_altitude_km", uniform(30, 50))
  if (chance(0.3)) {
    table("spin.screening")
    put("window", int(uniform(20, 200))); put("sigma", uniform(2.5, 5)); put("interference_s", uniform(0, 0.003))
  }
  if (chance(0.4)) {
    table("spin.prior")
    put("ra_deg", ra_deg + uniform(-10, 10)); put("dec_deg", dec_deg > 0 ? dec_deg - uniform(0, 10) : dec_deg + uniform(0, 10))
    put("sigma_deg", scaled(1, 30))
  }
  if (chance(0.2)) {
    table("spin.batch")
    printf "sun_angle = %s\nco2_height = %s\n", either("true", "false"), either("true", "false") > file
  }
}

function attitude(rate_rpm) {
  table("attitude")
  printf "model = \"spin\"\n" > file
  put("ra_deg", ra_deg); put("dec_deg", dec_deg); put("rate_rpm", rate_rpm); put("azimuth_deg", uniform(0, 360))
  if (chance(0.4)) put("rate_drift_rpm_h", uniform(-1, 1) * scaled(0.01, 0.05 * rate_rpm))
  if (chance(0.25)) {
    table("attitude.nutation")
    put("half_angle_deg", scaled(0.01, 2)); put("inertia_ratio", uniform(0.3, 1.7)); put("phase_deg", uniform(0, 360))
    put("growth_per_h", either(0, uniform(-3, 3)))
  }
  if (chance(0.15)) {
    table("attitude.coning"); put("tilt_deg", scaled(0.02, 1)); put("azimuth_deg", uniform(0, 360))
  }
}

function misplacements(both) {
  if (chance(0.2)) {
    table("truth.sun_sensor"); put("slit_cant_offset_deg", uniform(-0.2, 0.2)); put("slit_separation_offset_deg", uniform(-0.2, 0.2))
  }
  if (both < 0.85 && chance(0.3)) {
    table("truth.ir.north"); put("mount_angle_offset_deg", uniform(-0.3, 0.3)); put("chord_excess_deg", uniform(-0.2, 0.2))
  }
  if (both > 0.15 && chance(0.3)) {
    table("truth.ir.south"); put("mount_angle_offset_deg", uniform(-0.3, 0.3)); put("azimuth_offset_deg", uniform(-0.3, 0.3))
  }
}

function faults(duration_s, both,   from_s) {
  if (chance(0.5)) {
    table("faults")
    put("lost", uniform(0, 0.15)); put("spoilt", uniform(0, 0.05)); put("spurious", uniform(0, 0.1)); put("doubled", uniform(0, 0.03))
    if (chance(0.3)) put("interference_s", uniform(0, 0.002))
  }
  if (chance(0.1)) printf "\n[faults.channel.%s]\ndead = true\n", either("sun2", both < 0.85 ? "north_in" : "south_out") > file
  if (chance(0.2)) {
    from_s = uniform(0, 0.8) * duration_s
    printf "\n[[faults.silence]]\n" > file
    put("from_s", from_s); put("to_s", from_s + uniform(0, 0.3) * duration_s)
  }
}

function scenario(   rate_rpm, duration_s, north_deg, south_deg, both) {
  start_tai_s = 1600000000 + int(uniform(0, 300000000))
  rate_rpm = scaled(5.2, 190); rate_rad_s = rate_rpm * 6 * degree
  duration_s = scaled(25, 1000) * 60 / rate_rpm
  north_deg = chance(0.2) ? uniform(10, 170) : uniform(70, 95); south_deg = chance(0.2) ? uniform(10, 170) : north_deg + uniform(-5, 20)
  both = uniform(0, 1)
  printf "[spacecraft]\nid = \"RANDOM-%02d\"\nkind = \"spin\"\n", number > file
  orbit()
  axis(both < 0.85 ? north_deg : south_deg)
  table("pass")
  printf "start_tai_ns = %d000000000\n", start_tai_s > file
  put("duration_s", duration_s); put("seed", int(uniform(1, 1000000)))
  table("telemetry")
  printf "kind = \"%s\"\n", chance(0.2) ? "coded" : "pulses" > file
  attitude(rate_rpm)
  sensors(north_deg, south_deg, both)
  misplacements(both)
  faults(duration_s, both)
}

BEGIN {
  degree = atan2(0, -1) / 180
  state = 20261123
  for (number = 1; number <= count; ++number) {
    file = sprintf("%s/random-%02d.toml", folder, number)
    scenario()
    close(file)
  }
}
