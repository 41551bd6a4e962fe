//! Jobs that are queued by the forms of pages.

use std::time::Duration;

use reqwest::redirect::Policy;
use reqwest::{Client, StatusCode};
use sistership_store::testing::TestDatabase;

use super::harness::{Harness, config, read};
use super::openid::knowing::token;
use crate::Server;

impl Harness {
    /// Starts a server whose workers only notice jobs that wake them.
    async fn without_poll(database: TestDatabase) -> Self {
        let mut config = config(&database);
        config.leases.poll = Duration::from_secs(3600);
        let server = Server::start(config).await.unwrap();
        let client = Client::builder().redirect(Policy::none()).build().unwrap();
        Self { server, client, database }
    }

    /// Sends the form of a ship's page, and returns the path of the job that it leads to.
    async fn send_form(&self, ship: &str, action: &str, fields: &[(&str, &str)]) -> String {
        let page = self.client.get(self.url(&format!("/ships/{ship}"))).send().await.unwrap();
        let page = page.text().await.unwrap();
        let mut form = fields.to_vec();
        form.push(("form_token", token(&page)));
        let post = self.client.post(self.url(&format!("/ships/{ship}/{action}")));
        let post = post.header("content-type", "application/x-www-form-urlencoded");
        let post = post.body(serde_urlencoded::to_string(form).unwrap());
        let answer = post.header("origin", self.url("")).send().await.unwrap();
        let place =
            answer.headers().get("location").map(|place| place.to_str().unwrap().to_owned());
        assert_eq!(answer.status(), StatusCode::SEE_OTHER, "{}", answer.text().await.unwrap());
        place.unwrap()
    }

    /// Waits until a worker has claimed a job, and cancels it.
    async fn see_begun(&self, job: &str) {
        for _ in 0..100 {
            if self.get(&format!("/v1{job}")).await["state"] != "queued" {
                let delete = self.client.delete(self.url(&format!("/v1{job}")));
                delete.send().await.unwrap();
                return;
            }
            tokio::time::sleep(Duration::from_millis(100)).await;
        }
        panic!("no worker was woken: {}", self.get(&format!("/v1{job}")).await);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_job_of_a_form_begins_at_once() {
    let harness = Harness::without_poll(TestDatabase::new_sqlite()).await;
    let csv = "t_s,u_m_s,v_m_s,r_rad_s,delta_rad\n0,8,0,0,0\n1,8,0,0,0\n2,8,0,0,0\n3,8,0,0,0\n";
    let post =
        harness.client.post(harness.url("/v1/trials?ship=mariner&name=a.csv&diagnose=false"));
    let post = post.header("content-type", "text/csv").body(csv);
    let (status, uploaded) = read(post.send().await.unwrap()).await;
    assert_eq!(status, StatusCode::CREATED, "{uploaded}");
    for (action, fields) in [("refine", ("source", "kvlcc2")), ("diagnose", ("version", "1"))] {
        let job = harness.send_form("mariner", action, &[fields]).await;
        harness.see_begun(&job).await;
    }
    harness.server.stop().await;
}
