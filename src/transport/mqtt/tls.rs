//! TLS with rustls: whom to trust, who one is, and what is wrong with a certificate. Without the feature `plant-tls` there
//! is none, and whoever wants it is told.

use thiserror::Error;

/// Whom to trust.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Trust {
    /// The roots of this machine.
    System,
    /// These alone, as PEM.
    Roots(Vec<u8>),
}

/// Who one is, as PEM.
#[derive(Clone, PartialEq, Eq)]
pub struct Identity {
    /// The certificate, with those that lead to a root.
    pub certificates: Vec<u8>,
    /// Its key.
    pub key: Vec<u8>,
}

/// What is wrong with one end's trust in the other.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TlsError {
    /// The broker's certificate is of nobody who is trusted.
    #[error("its certificate is issued by nobody who is trusted here")]
    UnknownIssuer,
    /// It is for another name.
    #[error("its certificate is for another name")]
    WrongName,
    /// It is over.
    #[error("its certificate has expired")]
    Expired,
    /// It is not yet.
    #[error("its certificate is not valid yet")]
    NotYetValid,
    /// It was taken back.
    #[error("its certificate was revoked")]
    Revoked,
    /// It is something else.
    #[error("its certificate is not valid: {0}")]
    Certificate(String),
    /// Nobody speaks TLS there.
    #[error("it does not speak TLS on this port")]
    NoTls,
    /// The broker does not take this client's certificate, or wants one.
    #[error("it does not accept this client's certificate ({0})")]
    Rejected(String),
    /// Both have no version or cipher in common.
    #[error("no version or cipher of TLS is common to both ({0})")]
    NothingInCommon(String),
    /// A certificate or key of this client is none.
    #[error("{0}")]
    Setup(String),
    /// Anything else.
    #[error("TLS: {0}")]
    Other(String),
}

#[cfg(feature = "plant-tls")]
mod rustls_link {
    use std::fmt;
    use std::io;
    use std::sync::Arc;

    use tokio::net::TcpStream;
    use tokio_rustls::TlsConnector;
    use tokio_rustls::client::TlsStream;
    use tokio_rustls::rustls::pki_types::pem::PemObject as _;
    use tokio_rustls::rustls::pki_types::{CertificateDer, PrivateKeyDer, ServerName};
    use tokio_rustls::rustls::{
        AlertDescription, CertificateError, ClientConfig, Error, RootCertStore, crypto::ring::default_provider,
    };

    use super::{Identity, TlsError, Trust};

    /// How a broker is trusted.
    pub struct Tls {
        connector: TlsConnector,
        name: ServerName<'static>,
    }

    impl fmt::Debug for Tls {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "TLS to {:?}", self.name)
        }
    }

    impl Tls {
        /// With the broker of this name or address.
        ///
        /// # Errors
        /// If a certificate or a key is none, or this machine has no roots.
        pub fn new(host: &str, trust: &Trust, identity: Option<&Identity>) -> Result<Self, TlsError> {
            let name = ServerName::try_from(host.to_owned())
                .map_err(|_| TlsError::Setup(format!("'{host}' is not a valid name of a server")))?;
            let builder = ClientConfig::builder_with_provider(Arc::new(default_provider()))
                .with_safe_default_protocol_versions()
                .map_err(|error| TlsError::Other(error.to_string()))?
                .with_root_certificates(roots(trust)?);
            let config = match identity {
                None => builder.with_no_client_auth(),
                Some(Identity { certificates, key }) => {
                    let chain = certificates_of(certificates, "the certificate of this client")?;
                    let key = PrivateKeyDer::from_pem_slice(key).map_err(|_| {
                        TlsError::Setup("the key of this client is not a private key in PEM".to_owned())
                    })?;
                    builder.with_client_auth_cert(chain, key).map_err(|error| {
                        TlsError::Setup(format!("certificate and key of this client do not fit: {error}"))
                    })?
                }
            };
            Ok(Self { connector: TlsConnector::from(Arc::new(config)), name })
        }

        pub(in super::super) async fn connect(&self, stream: TcpStream) -> Result<TlsStream<TcpStream>, TlsError> {
            let connected = self.connector.connect(self.name.clone(), stream).await;
            connected.map_err(|error| {
                TlsError::of(&error).unwrap_or_else(|| match error.kind() {
                    io::ErrorKind::UnexpectedEof | io::ErrorKind::ConnectionReset => TlsError::NoTls,
                    _ => TlsError::Other(super::super::super::plain(&error)),
                })
            })
        }
    }

    fn roots(trust: &Trust) -> Result<RootCertStore, TlsError> {
        let mut store = RootCertStore::empty();
        match trust {
            Trust::System => {
                let found = rustls_native_certs::load_native_certs();
                let (_, _) = store.add_parsable_certificates(found.certs);
                if store.is_empty() {
                    return Err(TlsError::Setup("this machine has no certificates of authorities".to_owned()));
                }
            }
            Trust::Roots(pem) => {
                for certificate in certificates_of(pem, "the certificate of the authority")? {
                    store.add(certificate).map_err(|error| {
                        TlsError::Setup(format!("the certificate of the authority is not valid: {error}"))
                    })?;
                }
            }
        }
        Ok(store)
    }

    fn certificates_of(pem: &[u8], what: &str) -> Result<Vec<CertificateDer<'static>>, TlsError> {
        let found = CertificateDer::pem_slice_iter(pem).collect::<Result<Vec<_>, _>>();
        match found {
            Ok(found) if !found.is_empty() => Ok(found),
            _ => Err(TlsError::Setup(format!("{what} is not a certificate in PEM"))),
        }
    }

    impl TlsError {
        /// What rustls says, if an error is its.
        pub(in super::super) fn of(error: &io::Error) -> Option<Self> {
            let error = error.get_ref()?.downcast_ref::<Error>()?;
            Some(match error {
                Error::InvalidCertificate(why) => match why {
                    CertificateError::UnknownIssuer => Self::UnknownIssuer,
                    CertificateError::NotValidForName | CertificateError::NotValidForNameContext { .. } => {
                        Self::WrongName
                    }
                    CertificateError::Expired | CertificateError::ExpiredContext { .. } => Self::Expired,
                    CertificateError::NotValidYet | CertificateError::NotValidYetContext { .. } => Self::NotYetValid,
                    CertificateError::Revoked => Self::Revoked,
                    why => Self::Certificate(why.to_string()),
                },
                Error::InvalidMessage(_) => Self::NoTls,
                Error::PeerIncompatible(why) => Self::NothingInCommon(format!("{why:?}")),
                Error::AlertReceived(alert) => match alert {
                    AlertDescription::ProtocolVersion
                    | AlertDescription::HandshakeFailure
                    | AlertDescription::InsufficientSecurity => Self::NothingInCommon(format!("{alert:?}")),
                    alert => Self::Rejected(format!("{alert:?}")),
                },
                error => Self::Other(error.to_string()),
            })
        }
    }
}

#[cfg(not(feature = "plant-tls"))]
mod rustls_link {
    use std::io;

    use tokio::net::TcpStream;

    use super::{Identity, TlsError, Trust};

    /// How a broker is trusted: not at all in this build.
    #[derive(Debug)]
    pub enum Tls {}

    impl Tls {
        /// Says that there is none.
        ///
        /// # Errors
        /// Always.
        pub fn new(_: &str, _: &Trust, _: Option<&Identity>) -> Result<Self, TlsError> {
            Err(TlsError::Setup("this armctl was built without TLS (feature plant-tls)".to_owned()))
        }

        #[expect(clippy::unused_async, reason = "the other one waits")]
        pub(in super::super) async fn connect(&self, _: TcpStream) -> Result<TcpStream, TlsError> {
            match *self {}
        }
    }

    impl TlsError {
        pub(in super::super) fn of(_: &io::Error) -> Option<Self> {
            None
        }
    }
}

pub use self::rustls_link::Tls;
