/* A subscriber to what spindrift gives: prints spin axes, attitudes, alerts and the health of the
 * services in a partition, a line each, until interrupted.
 *
 *     idlc spindrift.idl && cc -o follow follow.c spindrift.c -I. -lddsc
 *     CYCLONEDDS_URI=file:///.../loopback.xml ./follow DOMAIN PARTITION
 */
#include <dds/dds.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "spindrift.h"

enum { kMostAtOnce = 64 };

static volatile sig_atomic_t stopped = 0;

static void stop(int signal) {
  (void)signal;
  stopped = 1;
}

static dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity < 0) {
    fprintf(stderr, "follow: %s: %s\n", what, dds_strretcode(-entity));
    exit(1);
  }
  return entity;
}

static void print_estimate(const void* sample) {
  static const char* const qualities[] = {"CONVERGING", "OK", "AMBIGUOUS", "DOUBTFUL", "LOST"};
  const spindrift_SpinEstimate* e = sample;
  printf("estimate %s %s t_tai_ns=%lld ra_deg=%.4f dec_deg=%.4f sigma_deg=%.4f rpm=%.6f %s\n",
         e->spacecraft, e->estimator, (long long)e->t_tai_ns, e->ra_deg, e->dec_deg, e->sigma_deg,
         e->spin_rate_rpm, qualities[e->quality]);
}

static void print_attitude(const void* sample) {
  const spindrift_AttitudeEstimate* a = sample;
  printf("attitude %s %s t_tai_ns=%lld q_icrf_body=%.9f,%.9f,%.9f,%.9f sigma_deg=%.4f %s\n",
         a->spacecraft, a->estimator, (long long)a->t_tai_ns, a->qx, a->qy, a->qz, a->qw,
         a->sigma_deg, a->status);
}

static void print_alert(const void* sample) {
  static const char* const severities[] = {"info", "warning", "critical"};
  static const char* const states[] = {"active", "acknowledged", "shelved", "cleared"};
  const spindrift_Alert* a = sample;
  printf("alert %s %s %s %s id=%s revision=%u: %s\n", a->spacecraft, a->dedupe_key,
         severities[a->severity], states[a->state], a->alert_id, (unsigned)a->revision, a->message);
}

static void print_health(const void* sample) {
  static const char* const links[] = {"waiting", "live", "stale"};
  const spindrift_Health* h = sample;
  printf("health %s received=%llu committed=%llu: %s\n", h->service,
         (unsigned long long)h->samples_received, (unsigned long long)h->samples_committed,
         h->status);
  for (uint32_t i = 0; i < h->spacecraft._length; ++i) {
    const spindrift_SpacecraftHealth* one = &h->spacecraft._buffer[i];
    if (one->estimator[0] == '\0') {
      printf("verdict %s %s: no answer\n", one->spacecraft, links[one->link]);
    } else {
      printf("verdict %s %s: %s by %s, sigma_deg=%.4f against=\"%s\"\n", one->spacecraft,
             links[one->link], one->quality, one->estimator, one->sigma_deg, one->against);
    }
  }
}

struct Followed {
  const char* topic;
  const dds_topic_descriptor_t* type;
  void (*print)(const void* sample);
  dds_entity_t reader;
};

static struct Followed followed[] = {
    {"spindrift/spin_estimate", &spindrift_SpinEstimate_desc, print_estimate, 0},
    {"spindrift/attitude", &spindrift_AttitudeEstimate_desc, print_attitude, 0},
    {"spindrift/alert", &spindrift_Alert_desc, print_alert, 0},
    {"spindrift/health", &spindrift_Health_desc, print_health, 0},
};
enum { kFollowed = sizeof followed / sizeof followed[0] };

/* The samples stay the middleware's: they are lent and given back. */
static void take(const struct Followed* one) {
  void* samples[kMostAtOnce] = {0};
  dds_sample_info_t infos[kMostAtOnce];
  const dds_return_t count = dds_take(one->reader, samples, infos, kMostAtOnce, kMostAtOnce);
  for (dds_return_t i = 0; i < count; ++i) {
    if (infos[i].valid_data) { /* Otherwise a writer ended: its last word stands. */
      one->print(samples[i]);
    }
  }
  if (count > 0) {
    (void)dds_return_loan(one->reader, samples, count);
  }
  fflush(stdout);
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: follow DOMAIN PARTITION\n");
    return 2;
  }
  if (getenv("CYCLONEDDS_URI") == NULL) {
    fprintf(stderr,
            "follow: CYCLONEDDS_URI must name a configuration: without one Cyclone "
            "multicasts on the outside interface\n");
    return 2;
  }
  signal(SIGINT, stop);
  signal(SIGTERM, stop);
  const dds_entity_t participant =
      checked(dds_create_participant((dds_domainid_t)strtoul(argv[1], NULL, 10), NULL, NULL),
              "participant");
  /* The partition belongs to the subscriber. */
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition1(qos, argv[2]);
  const dds_entity_t subscriber =
      checked(dds_create_subscriber(participant, qos, NULL), "subscriber");
  dds_delete_qos(qos);
  /* Reliable and transient-local: who joins late gets the current state of each instance first. */
  qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t waitset = checked(dds_create_waitset(participant), "wait set");
  for (int i = 0; i < kFollowed; ++i) {
    const dds_entity_t topic =
        checked(dds_create_topic(participant, followed[i].type, followed[i].topic, NULL, NULL),
                followed[i].topic);
    followed[i].reader =
        checked(dds_create_reader(subscriber, topic, qos, NULL), followed[i].topic);
    const dds_entity_t condition =
        checked(dds_create_readcondition(followed[i].reader, DDS_ANY_STATE), followed[i].topic);
    (void)dds_waitset_attach(waitset, condition, 0);
  }
  dds_delete_qos(qos);
  while (!stopped) {
    if (dds_waitset_wait(waitset, NULL, 0, DDS_MSECS(200)) > 0) {
      for (int i = 0; i < kFollowed; ++i) {
        take(&followed[i]);
      }
    }
  }
  dds_delete(participant);
  return 0;
}
