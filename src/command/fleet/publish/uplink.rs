//! Connection to a broker; the only file of this folder that uses the transport.

use std::time::Duration;

use super::broker::{Broker, Url};
use super::delivery;
use armctl_transport::mqtt::Client;
pub use armctl_transport::mqtt::{
    Endpoint, Event, Hello, Identity, Loss, Message, Refusal, SendError, Tls, TlsError, Trust, Version, Will,
};

/// Time limit of the whole connection procedure: TCP, TLS, answer.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

impl delivery::Broker for Broker {
    type Uplink = Client;

    fn url(&self) -> &Url {
        &self.url
    }

    async fn open(&self, client_id: String, will: Will) -> Result<Client, Loss> {
        Client::open(&self.endpoint, &self.connect_packet(client_id, will), CONNECT_TIMEOUT).await
    }
}

impl delivery::Uplink for Client {
    async fn next(&mut self) -> Event {
        Self::next(self).await
    }

    fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError> {
        Self::publish(self, message)
    }

    fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError> {
        Self::subscribe(self, topics)
    }

    fn unsubscribe(&mut self, topics: &[String]) -> Result<(), SendError> {
        Self::unsubscribe(self, topics)
    }

    fn ping(&mut self) -> u64 {
        Self::ping(self)
    }

    fn room(&self) -> Option<u16> {
        Self::room(self)
    }

    fn unsent(&mut self) -> usize {
        Self::unsent(self)
    }

    async fn close(self) {
        Self::close(self).await;
    }
}
